// The file of a model of a moving domain: kind, version, scene, basis, weights, runs, provenance.
#include <cmath>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/model_file_parts.hpp"
#include "rom/moving_domain/moving_model.hpp"

namespace undula::rom {
namespace {

constexpr FileFormat file_format{"undula moving-domain model", "a model of a moving domain", 1};

struct RangeEntry {
  const char* name;
  double TrainingBox::*low;
  double TrainingBox::*high;
  const char* unit;
};
constexpr RangeEntry ranges[] = {
    {"frequency", &TrainingBox::frequency_low_Hz, &TrainingBox::frequency_high_Hz, "Hz"},
    {"voltage", &TrainingBox::stroke_low_mm, &TrainingBox::stroke_high_mm, "V"},
    {"head", &TrainingBox::head_low_mmHg, &TrainingBox::head_high_mmHg, "mmHg"},
};

struct RunEntry {
  const char* name;
  double MovingRun::*value;
  const char* unit;
};
constexpr RunEntry run_entries[] = {
    {"frequency", &MovingRun::frequency_Hz, "Hz"},
    {"voltage", &MovingRun::voltage_V, "V"},
    {"head", &MovingRun::head_mmHg, "mmHg"},
    {"flow", &MovingRun::flow_l_per_min, "l/min"},
    {"standard_error", &MovingRun::standard_error_l_per_min, "l/min"},
    {"stroke", &MovingRun::stroke_mm, "mm"},
    {"fom_seconds", &MovingRun::fom_seconds, "s"},
    {"rom_flow", &MovingRun::rom_flow_l_per_min, "l/min"},
    {"rom_standard_error", &MovingRun::rom_standard_error_l_per_min, "l/min"},
    {"rom_stroke", &MovingRun::rom_stroke_mm, "mm"},
    {"rom_seconds", &MovingRun::rom_seconds, "s"},
};

[[noreturn]] void refuse(const std::string& what, const std::string& seen, const std::string& allowed,
                         const std::string& file) {
  throw InputError("the model of a moving domain is not one that training makes: " + what, seen, allowed,
                   file);
}

/// Most weights are 0: place and value of the others.
void write_weights(Hdf5File& file, const std::string& group, const std::vector<double>& weights) {
  std::vector<int> places;
  std::vector<double> values;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0))
      refuse(group, std::to_string(weights[i]) + " at " + std::to_string(i), "numbers >= 0",
             file.path().string());
    if (weights[i] > 0) {
      places.push_back(static_cast<int>(i));
      values.push_back(weights[i]);
    }
  }
  file.create_group(group);
  file.write_attribute(group, "count", static_cast<int>(weights.size()));
  file.write(group + "/places", places);
  file.write(group + "/values", values, {values.size()}, "1");
}

std::vector<double> read_weights(const Hdf5File& file, const std::string& group) {
  const int count = file.read_attribute<int>(group, "count");
  const auto places = file.read<int>(group + "/places");
  const auto values = file.read<double>(group + "/values", {places.size()});
  if (count < 0 || places.size() > static_cast<std::size_t>(count))
    refuse(group, std::to_string(count) + " weights", "as many as there are places, or more",
           file.path().string());
  std::vector<double> weights(static_cast<std::size_t>(count), 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] < 0 || places[i] >= count || !(values[i] > 0) || !std::isfinite(values[i]))
      refuse(group, std::to_string(values[i]) + " at " + std::to_string(places[i]),
             "numbers > 0 at places below " + std::to_string(count), file.path().string());
    weights[static_cast<std::size_t>(places[i])] = values[i];
  }
  return weights;
}

} // namespace

bool holds_moving_model(const std::string& name) {
  return std::filesystem::exists(name) && kind_of(Hdf5File::open_unchecked(name)) == file_format.kind;
}

void save_moving_model(const MovingModel& model, const std::string& name) {
  auto file = Hdf5File::create(name);
  write_format_version(file, file_format);
  file.write_text("scene", model.scene);
  file.write_text("profile", model.profile);
  const auto rows = static_cast<std::size_t>(model.basis.rows()),
             modes = static_cast<std::size_t>(model.basis.cols());
  // A column-major [unknown][mode] matrix is a row-major [mode][unknown] array.
  file.write("basis", std::span(model.basis.data(), rows * modes), {modes, rows});
  file.write_attribute("basis", "pressure_modes", model.pressure_modes);
  write_weights(file, "parts", model.part_weights);
  write_weights(file, "cells", model.cell_weights);
  file.create_group("ranges");
  for (const auto& range : ranges)
    file.write(std::string("ranges/") + range.name,
               std::vector<double>{model.box.*range.low, model.box.*range.high}, {2}, range.unit);
  std::vector<int> held_out;
  for (const auto& run : model.runs) held_out.push_back(run.held_out ? 1 : 0);
  file.write("runs/held_out", held_out);
  for (const auto& entry : run_entries) {
    std::vector<double> values;
    for (const auto& run : model.runs) values.push_back(run.*entry.value);
    file.write(std::string("runs/") + entry.name, values, {values.size()}, entry.unit);
  }
  file.write_attribute("runs", "error_l_per_min", model.error_l_per_min);
  write_provenance(file, model.provenance);
  file.commit();
}

MovingModel load_moving_model(const std::string& name) {
  const auto file = Hdf5File::open_sealed(name);
  checked_version(file, file_format);
  MovingModel model;
  model.scene = file.read_text("scene");
  model.profile = file.read_text("profile");
  const auto extents = file.extents("basis");
  if (extents.size() != 2) refuse("basis", std::to_string(extents.size()) + " dimensions", "2", name);
  const auto values = file.read<double>("basis");
  model.basis = Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Eigen::Index>(extents[1]),
                                                  static_cast<Eigen::Index>(extents[0]));
  if (!model.basis.allFinite()) refuse("basis", "nan or inf", "finite numbers", name);
  model.pressure_modes = file.read_attribute<int>("basis", "pressure_modes");
  if (model.pressure_modes < 0 || model.pressure_modes > model.basis.cols())
    refuse("pressure modes", std::to_string(model.pressure_modes),
           "0 to " + std::to_string(model.basis.cols()), name);
  model.part_weights = read_weights(file, "parts");
  model.cell_weights = read_weights(file, "cells");
  for (const auto& range : ranges) {
    const auto bounds = file.read<double>(std::string("ranges/") + range.name, {2});
    if (!(bounds[0] <= bounds[1]) || !std::isfinite(bounds[0]) || !std::isfinite(bounds[1]))
      refuse(std::string("range of ") + range.name,
             std::to_string(bounds[0]) + " to " + std::to_string(bounds[1]),
             "finite numbers, the lower one first", name);
    model.box.*range.low = bounds[0];
    model.box.*range.high = bounds[1];
  }
  const auto held_out = file.read<int>("runs/held_out");
  model.runs.resize(held_out.size());
  for (std::size_t i = 0; i < held_out.size(); ++i) model.runs[i].held_out = held_out[i] != 0;
  for (const auto& entry : run_entries) {
    const auto column = file.read<double>(std::string("runs/") + entry.name, {held_out.size()});
    for (std::size_t i = 0; i < column.size(); ++i) model.runs[i].*entry.value = column[i];
  }
  model.error_l_per_min = file.read_attribute<double>("runs", "error_l_per_min");
  if (!(model.error_l_per_min >= 0))
    refuse("stated error", std::to_string(model.error_l_per_min), "a number >= 0, or infinite", name);
  model.provenance = read_provenance(file);
  return model;
}

} // namespace undula::rom
