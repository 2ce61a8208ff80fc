#include "apps/output/moving_model_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

using training::BuiltMovingModel;

std::string modes_text(const BuiltMovingModel& built) {
  const auto& bases = built.bases;
  const auto& cubature = built.cubature;
  std::string text = "modes: " + std::to_string(bases.velocity) + " velocity (" +
                     decimals(100 * bases.captured_velocity, 4) + " % of the energy), " +
                     std::to_string(bases.lifted) + " displacement (" +
                     decimals(100 * bases.captured_displacement, 4) + " %), " +
                     std::to_string(bases.supremizers) + " supremizers, " + std::to_string(bases.pressure) +
                     " pressure (" + decimals(100 * bases.captured_pressure, 4) + " %)\n";
  if (cubature.parts == 0) {
    return text + "elements: all\n";
  }
  return text + "elements: " + std::to_string(cubature.parts) + " of " +
         std::to_string(cubature.part_weights.size()) + " parts of the fluid (forces off by " +
         decimals(100 * cubature.part_error, 3) + " %), " + std::to_string(cubature.cells) + " of " +
         std::to_string(cubature.cell_weights.size()) + " cells of the solids (" +
         decimals(100 * cubature.cell_error, 3) + " %)\n";
}

} // namespace

std::string moving_model_text(const BuiltMovingModel& built, const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  double square = 0, worst = 0;
  int judged = 0;
  for (const auto& run : built.model.runs) {
    if (!run.held_out) {
      continue;
    }
    const double error = std::abs(run.rom_flow_l_per_min - run.flow_l_per_min);
    square += error * error;
    worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
    ++judged;
    rows.push_back({plain_number(run.frequency_Hz), decimals(run.voltage_V, 2), decimals(run.head_mmHg, 2),
                    decimals(run.flow_l_per_min, 3), decimals(run.standard_error_l_per_min, 3),
                    decimals(run.rom_flow_l_per_min, 3), decimals(run.rom_standard_error_l_per_min, 3),
                    decimals(run.stroke_mm, 4), decimals(run.rom_stroke_mm, 4), decimals(run.fom_seconds, 0),
                    decimals(run.rom_seconds, 1)});
  }
  std::string text = modes_text(built);
  if (judged > 0) {
    text += "\nheld out:\n" +
            text_table({"f (Hz)", "voltage (V)", "head (mmHg)", "flow FOM (l/min)", "standard error",
                        "flow ROM (l/min)", "standard error", "stroke FOM (mm)", "stroke ROM (mm)", "FOM (s)",
                        "ROM (s)"},
                       rows) +
            "\nflow: rms " + decimals(std::sqrt(square / judged), 3) + " l/min (" +
            decimals(100 * std::sqrt(square / judged) / built.flow_range_l_per_min, 2) +
            " % of the range), worst " + decimals(worst, 3) + "; stated error " +
            decimals(built.model.error_l_per_min, 3) + "\n";
  }
  return text + "written: " + file + "\n";
}

std::string moving_model_json(const BuiltMovingModel& built, const std::string& file) {
  const auto& bases = built.bases;
  const auto& cubature = built.cubature;
  nlohmann::ordered_json result = {{"model", file},
                                   {"velocity_modes", bases.velocity},
                                   {"displacement_modes", bases.lifted},
                                   {"supremizers", bases.supremizers},
                                   {"pressure_modes", bases.pressure},
                                   {"captured_velocity", bases.captured_velocity},
                                   {"captured_displacement", bases.captured_displacement},
                                   {"captured_pressure", bases.captured_pressure},
                                   {"parts", cubature.parts},
                                   {"of_parts", cubature.part_weights.size()},
                                   {"part_error", cubature.part_error},
                                   {"cells", cubature.cells},
                                   {"of_cells", cubature.cell_weights.size()},
                                   {"cell_error", cubature.cell_error},
                                   {"flow_range_l_per_min", built.flow_range_l_per_min},
                                   {"error_l_per_min", built.model.error_l_per_min},
                                   {"left_out", built.left_out},
                                   {"seconds", built.seconds},
                                   {"runs", nlohmann::ordered_json::array()}};
  for (const auto& run : built.model.runs) {
    result["runs"].push_back({{"held_out", run.held_out},
                              {"frequency_Hz", run.frequency_Hz},
                              {"voltage_V", run.voltage_V},
                              {"head_mmHg", run.head_mmHg},
                              {"flow_l_per_min", run.flow_l_per_min},
                              {"standard_error_l_per_min", run.standard_error_l_per_min},
                              {"stroke_mm", run.stroke_mm},
                              {"fom_seconds", run.fom_seconds},
                              {"rom_flow_l_per_min", run.rom_flow_l_per_min},
                              {"rom_standard_error_l_per_min", run.rom_standard_error_l_per_min},
                              {"rom_stroke_mm", run.rom_stroke_mm},
                              {"rom_seconds", run.rom_seconds}});
  }
  return result.dump(2) + "\n";
}

} // namespace undula::apps
