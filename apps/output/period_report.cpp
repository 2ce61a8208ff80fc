#include "apps/output/period_report.hpp"

#include <nlohmann/json.hpp>

#include "apps/output/gnuplot.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

constexpr int phases_drawn = 8;

const PeriodQuantity* find_quantity(const PeriodReport& report, const std::string& name) {
  for (const PeriodQuantity& quantity : report.quantities) {
    if (quantity.name == name) {
      return &quantity;
    }
  }
  return nullptr;
}

double degrees(Eigen::Index phase, Eigen::Index phases) {
  return 360.0 * static_cast<double>(phase) / static_cast<double>(phases);
}

std::string point_title(const OperatingPoint& point) {
  const bool by_voltage = point.drive == fom::Drive::voltage;
  return plain_number(point.frequency) + " Hz, " +
         (by_voltage ? plain_number(point.voltage) + " V, "
                     : plain_number(units::length_to_mm(point.stroke)) + " mm, ") +
         plain_number(units::pressure_to_mmHg(point.head)) + " mmHg";
}

} // namespace

PeriodReport period_report(const rom::Emulator& emulator, const rom::EmulatorPoint& point) {
  PeriodReport report;
  for (const auto& response : emulator.responses) {
    report.quantities.push_back(
        {response.name, response.unit, response.places_mm, rom::emulate(emulator, response, point)});
  }
  return report;
}

std::string period_table(const PeriodReport& report) {
  std::vector<std::string> head = {"phase (degrees)"};
  std::string errors;
  for (const PeriodQuantity& quantity : report.quantities) {
    const auto& places = quantity.places_mm;
    if (places.size() == 1) {
      head.push_back(quantity.name);
    } else {
      head.push_back(quantity.name + " at " + plain_number(places.front()) + " mm");
      head.push_back("at " + plain_number(places.back()) + " mm");
    }
    errors += quantity.name + ": stated error " + decimals(quantity.response.error, 4) + " " + quantity.unit +
              " (rms over the period)\n";
  }
  std::vector<std::vector<std::string>> rows;
  const Eigen::Index phases = report.quantities.front().response.values.cols();
  for (Eigen::Index k = 0; k < phases; ++k) {
    std::vector<std::string> row = {decimals(degrees(k, phases), 1)};
    for (const PeriodQuantity& quantity : report.quantities) {
      const auto values = quantity.response.values.col(k);
      row.push_back(decimals(values[0], 4));
      if (values.size() > 1) {
        row.push_back(decimals(values[values.size() - 1], 4));
      }
    }
    rows.push_back(std::move(row));
  }
  return text_table(head, rows) + "\n" + errors;
}

std::string period_json(const PeriodReport& report, const OperatingPoint& point) {
  const bool by_voltage = point.drive == fom::Drive::voltage;
  nlohmann::ordered_json result = {{"frequency_Hz", point.frequency},
                                   {by_voltage ? "voltage_V" : "stroke_mm",
                                    by_voltage ? point.voltage : units::length_to_mm(point.stroke)},
                                   {"head_mmHg", units::pressure_to_mmHg(point.head)},
                                   {"quantities", nlohmann::ordered_json::array()}};
  for (const PeriodQuantity& quantity : report.quantities) {
    nlohmann::ordered_json phases = nlohmann::ordered_json::array();
    for (const auto values : quantity.response.values.colwise()) {
      phases.push_back(std::vector<double>(values.begin(), values.end()));
    }
    result["quantities"].push_back({{"name", quantity.name},
                                    {"unit", quantity.unit},
                                    {"places_mm", quantity.places_mm},
                                    {"error", quantity.response.error},
                                    {"values_by_phase", phases}});
  }
  return result.dump(2) + "\n";
}

void plot_period(const std::filesystem::path& picture, const PeriodReport& report,
                 const OperatingPoint& point) {
  std::string data, commands = "set multiplot layout 2,1 title " + gnuplot_string(point_title(point)) + "\n";
  int blocks = 0;
  const auto add = [&](const std::string& rows) {
    data += rows + "\n\n";
    return std::to_string(blocks++);
  };
  if (const PeriodQuantity* membrane = find_quantity(report, rom::membrane_response)) {
    const auto& values = membrane->response.values;
    std::string reach;
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      reach += plain_number(membrane->places_mm[static_cast<std::size_t>(i)]) + " " +
               exact_number(values.row(i).minCoeff()) + " " + exact_number(values.row(i).maxCoeff()) + "\n";
    }
    commands +=
        "set xlabel 'radius (mm)'\nset ylabel 'axial displacement (mm)'\nset key outside right\nplot data "
        "index " +
        add(reach) + " using 1:2:3 with filledcurves fc rgb '#dddddd' title 'envelope'";
    for (int k = 0; k < phases_drawn; ++k) {
      const Eigen::Index phase = k * values.cols() / phases_drawn;
      std::string line;
      for (Eigen::Index i = 0; i < values.rows(); ++i) {
        line += plain_number(membrane->places_mm[static_cast<std::size_t>(i)]) + " " +
                exact_number(values(i, phase)) + "\n";
      }
      commands += ", data index " + add(line) + " using 1:2 with lines lw 1.5 title '" +
                  decimals(degrees(phase, values.cols()), 0) + " degrees'";
    }
    commands += "\n";
  }
  if (const PeriodQuantity* outflow = find_quantity(report, rom::outflow_response)) {
    const auto& values = outflow->response.values;
    std::string rows;
    for (Eigen::Index k = 0; k <= values.cols(); ++k) {
      rows +=
          plain_number(degrees(k, values.cols())) + " " + exact_number(values(0, k % values.cols())) + "\n";
    }
    commands +=
        "set xlabel 'phase (degrees)'\nset ylabel 'outflow (l/min)'\nset xrange [0:360]\nset xtics 45\n"
        "plot data index " +
        add(rows) + " using 1:2 with lines lw 2 title 'out of the pump', " + exact_number(values.mean()) +
        " with lines dt 2 lc rgb '#888888' title 'mean'\n";
  }
  draw_picture(picture, data, commands + "unset multiplot\n");
}

} // namespace undula::apps
