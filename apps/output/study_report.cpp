#include "apps/output/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/output/curve_report.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

constexpr std::size_t most_rows = 40, most_columns = 8;

std::optional<double> value_of(const StudyRecord& run, const std::string& quantity) {
  const auto found = std::ranges::find(run.quantities, quantity, &StudyQuantity::name);
  return found == run.quantities.end() || !std::isfinite(found->value) ? std::nullopt
                                                                       : std::optional(found->value);
}

const Sensitivities& sensitivities_of(const StudyReport& report, const std::string& quantity) {
  return std::ranges::find(report.analyses, quantity, &StudyReport::Analysis::quantity)->of_keys;
}

/// Scaled to [-1, 1] over the range of a key.
double scaled(const StudyRange& range, double value) {
  return 2 * (value - range.low) / (range.high - range.low) - 1;
}

std::string number_or_dash(double value, int count) {
  return std::isfinite(value) ? decimals(value, count) : "-";
}

std::string sensitivity_text(const std::string& quantity, const Sensitivities& found) {
  if (found.keys.empty()) {
    return quantity + " does not change over " + std::to_string(found.runs) +
           " runs, or they are too few: no sensitivities\n";
  }
  std::vector<std::vector<std::string>> rows;
  for (const KeySensitivity& key : found.keys) {
    rows.push_back({key.key, decimals(key.standardised, 3), number_or_dash(key.first_order, 3),
                    number_or_dash(key.total, 3)});
  }
  std::string text =
      "sensitivities of " + quantity + ", " + std::to_string(found.runs) + " runs:\n" +
      text_table({"key", "standardised coefficient", "first-order index", "total index"}, rows) +
      "the linear law explains " + decimals(100 * found.linear, 1) + " % of the variance";
  text += std::isfinite(found.left_out)
              ? "; the polynomial of degree 2 behind the indices predicts " +
                    decimals(100 * found.left_out, 1) + " % of it at runs left out\n"
              : "; too few runs, or too few values, for a polynomial of degree 2 and its indices\n";
  return text;
}

nlohmann::ordered_json sensitivity_json(const Sensitivities& found) {
  nlohmann::ordered_json result = {{"runs", found.runs},
                                   {"mean", found.mean},
                                   {"linear_r2", finite_or_null(found.linear)},
                                   {"polynomial_q2", finite_or_null(found.left_out)},
                                   {"keys", nlohmann::ordered_json::array()}};
  for (const KeySensitivity& key : found.keys) {
    result["keys"].push_back({{"key", key.key},
                              {"standardised_coefficient", key.standardised},
                              {"first_order_index", finite_or_null(key.first_order)},
                              {"total_index", finite_or_null(key.total)}});
  }
  return result;
}

/// A cell of a CSV file.
std::string cell(std::string text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) {
    text.insert(at, 1, '"');
  }
  return '"' + text + '"';
}

/// The quantity over one key after the other, with what the key does by itself.
void plot_runs(const StudyReport& report, const std::string& quantity, const std::filesystem::path& folder) {
  constexpr int line_points = 41;
  const Sensitivities& found = sensitivities_of(report, quantity);
  std::string data, commands;
  const std::size_t keys = report.ranges.size(), columns = std::min<std::size_t>(keys, 3),
                    rows = (keys + columns - 1) / columns;
  commands += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + " title " +
              gnuplot_string(report.scene + ": " + quantity + ", " + std::to_string(found.runs) + " runs") +
              "\nset grid\nset ylabel " + gnuplot_string(quantity) + "\n";
  for (std::size_t k = 0; k < keys; ++k) {
    const StudyRange& range = report.ranges[k];
    data += (k == 0 ? "# " : "\n\n# ") + range.key + ", " + quantity + "\n";
    for (const StudyRecord& run : report.runs) {
      if (const auto value = value_of(run, quantity)) {
        data += exact_number(run.values[k]) + " " + exact_number(*value) + "\n";
      }
    }
    std::string line;
    const bool has_effect = !found.keys.empty() && std::isfinite(found.keys[k].first_order);
    data += "\n\n# main effect\n";
    for (int i = 0; i < line_points && has_effect; ++i) {
      const double value = range.low + (range.high - range.low) * i / (line_points - 1),
                   x = scaled(range, value);
      data +=
          exact_number(value) + " " +
          exact_number(found.mean + found.keys[k].slope * x + found.keys[k].bend * 0.5 * (3 * x * x - 1)) +
          "\n";
    }
    commands += "set xlabel " + gnuplot_string(range.key) + "\nset xtics " + plain_number(range.low) + "," +
                plain_number((range.high - range.low) / 3) + " format '%.3g'" + "\nplot data index " +
                std::to_string(2 * k) + " with points pt 7 ps 0.6 lc rgb '#1f4e8c' notitle" +
                (has_effect ? ", data index " + std::to_string(2 * k + 1) +
                                  " with lines lw 2 lc rgb '#c0392b' title 'by itself'"
                            : "") +
                "\n";
  }
  draw_picture(folder / "runs.png", data, commands + "unset multiplot\n");
}

void plot_indices(const StudyReport& report, const std::string& quantity,
                  const std::filesystem::path& folder) {
  const Sensitivities& found = sensitivities_of(report, quantity);
  if (found.keys.empty() || !std::isfinite(found.left_out)) {
    return;
  }
  std::string data = "# key, first-order index, total index\n", tics;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    const KeySensitivity& key = found.keys[k];
    data += std::to_string(k) + " " + exact_number(key.first_order) + " " + exact_number(key.total) + "\n";
    tics += (k == 0 ? "" : ", ") + gnuplot_string(key.key) + " " + std::to_string(k);
  }
  draw_picture(
      folder / "sensitivities.png", data,
      "set title " +
          gnuplot_string(report.scene + ": what changes " + quantity + " (Q^2 " +
                         decimals(found.left_out, 3) + ")") +
          "\nset style fill solid 0.8\nset boxwidth 0.35\nset yrange [0:*]\nset xrange [-0.7:" +
          decimals(static_cast<double>(found.keys.size()) - 0.3, 1) +
          "]\nset key outside top center horizontal\nset grid ytics\nset ylabel 'index'\nset xtics (" + tics +
          ")\nplot data using ($1-0.18):2 with boxes lc rgb '#1f4e8c' title 'first order', "
          "data using ($1+0.18):3 with boxes lc rgb '#c0392b' title 'total'\n");
}

} // namespace

void analyse(StudyReport& report) {
  report.analyses.clear();
  for (const StudyRecord& run : report.runs) {
    for (const StudyQuantity& one : run.quantities) {
      if (std::ranges::find(report.analyses, one.name, &StudyReport::Analysis::quantity) ==
          report.analyses.end()) {
        report.analyses.push_back({one.name, {}});
      }
    }
  }
  const auto keys = static_cast<Eigen::Index>(report.ranges.size());
  for (StudyReport::Analysis& analysis : report.analyses) {
    std::vector<std::vector<double>> places;
    std::vector<double> values;
    for (const StudyRecord& run : report.runs) {
      if (const auto value = value_of(run, analysis.quantity)) {
        places.push_back(run.values);
        values.push_back(*value);
      }
    }
    Eigen::MatrixXd x(static_cast<Eigen::Index>(values.size()), keys);
    for (std::size_t run = 0; run < places.size(); ++run) {
      for (std::size_t k = 0; k < report.ranges.size(); ++k) {
        x(static_cast<Eigen::Index>(run), static_cast<Eigen::Index>(k)) =
            scaled(report.ranges[k], places[run][k]);
      }
    }
    analysis.of_keys = sensitivities(
        report.plan.keys, x,
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  }
}

std::string values_text(const std::vector<std::string>& keys, const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    text += (i == 0 ? "" : ", ") + keys[i] + " = " + plain_number(values[i]);
  }
  return text;
}

std::string chosen_quantity(const StudyReport& report, const std::string& asked) {
  std::string names;
  for (const StudyReport::Analysis& one : report.analyses) {
    if (one.quantity == asked) {
      return asked;
    }
    names += (names.empty() ? "" : ", ") + one.quantity;
  }
  if (report.analyses.empty()) {
    throw NumericsError("no run of the study has a result",
                        "every run; the first: " + report.runs.front().reason,
                        "another range of the keys, or what the messages say");
  }
  if (!asked.empty()) {
    throw InputError("no run of the study has this quantity", asked, names, "--quantity");
  }
  return report.analyses.front().quantity;
}

std::string study_text(const StudyReport& report, const std::string& quantity) {
  std::vector<std::string> shown = {quantity};
  for (const StudyReport::Analysis& one : report.analyses) {
    if (shown.size() < most_columns && one.quantity != quantity) {
      shown.push_back(one.quantity);
    }
  }
  std::vector<std::string> header = {"run"};
  header.insert(header.end(), report.plan.keys.begin(), report.plan.keys.end());
  header.insert(header.end(), shown.begin(), shown.end());
  header.emplace_back("state");
  std::vector<std::vector<std::string>> rows;
  int without = 0;
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    const StudyRecord& run = report.runs[i];
    without += run.quantities.empty() ? 1 : 0;
    if (i >= most_rows) {
      continue;
    }
    std::vector<std::string> row = {std::to_string(i + 1)};
    for (const double value : run.values) {
      row.push_back(plain_number(value));
    }
    for (const std::string& name : shown) {
      const auto value = value_of(run, name);
      row.push_back(value ? plain_number(*value) : "-");
    }
    row.push_back(run.state);
    rows.push_back(std::move(row));
  }
  std::string text = text_table(header, rows);
  if (report.runs.size() > most_rows) {
    text += "... " + std::to_string(report.runs.size() - most_rows) + " more in " + report.folder +
            "/table.csv\n";
  }
  if (without > 0) {
    text += std::to_string(without) + " of " + std::to_string(report.runs.size()) +
            " runs have no result: state and reason stand in the table\n";
  }
  return text + "\n" + sensitivity_text(quantity, sensitivities_of(report, quantity));
}

std::string study_json(const StudyReport& report) {
  nlohmann::ordered_json result = {{"scene", report.scene},
                                   {"folder", report.folder},
                                   {"plan", report.plan.full ? "full" : "space-filling"},
                                   {"keys", nlohmann::ordered_json::array()},
                                   {"runs", nlohmann::ordered_json::array()},
                                   {"sensitivities", nlohmann::ordered_json::object()}};
  for (const StudyRange& range : report.ranges) {
    result["keys"].push_back({{"key", range.key}, {"low", range.low}, {"high", range.high}});
    if (range.count > 0) {
      result["keys"].back()["count"] = range.count;
    }
  }
  for (const StudyRecord& run : report.runs) {
    nlohmann::ordered_json entry = {{"values", run.values},
                                    {"state", run.state},
                                    {"reason", run.reason},
                                    {"quantities", nlohmann::ordered_json::object()},
                                    {"seconds", run.seconds}};
    for (const StudyQuantity& one : run.quantities) {
      entry["quantities"][one.name] = finite_or_null(one.value);
    }
    result["runs"].push_back(std::move(entry));
  }
  for (const StudyReport::Analysis& one : report.analyses) {
    result["sensitivities"][one.quantity] = sensitivity_json(one.of_keys);
  }
  return result.dump(2) + "\n";
}

void write_study_table(const StudyReport& report, const std::filesystem::path& file) {
  std::string text = "run";
  for (const std::string& key : report.plan.keys) {
    text += "," + cell(key);
  }
  for (const StudyReport::Analysis& one : report.analyses) {
    text += "," + cell(one.quantity);
  }
  text += ",state,reason,seconds\n";
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    const StudyRecord& run = report.runs[i];
    text += std::to_string(i + 1);
    for (const double value : run.values) {
      text += "," + exact_number(value);
    }
    for (const StudyReport::Analysis& one : report.analyses) {
      const auto value = value_of(run, one.quantity);
      text += "," + (value ? exact_number(*value) : std::string());
    }
    text += "," + run.state + "," + cell(run.reason) + "," + exact_number(run.seconds) + "\n";
  }
  replace_text_file(file, text);
}

void plot_study(const StudyReport& report, const std::string& quantity, const std::filesystem::path& folder) {
  plot_runs(report, quantity, folder);
  plot_indices(report, quantity, folder);
}

} // namespace undula::apps
