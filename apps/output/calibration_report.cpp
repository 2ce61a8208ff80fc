#include "apps/output/calibration_report.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/output/curve_report.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/text_table.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/text_file.hpp"
#include "training/calibration/posterior.hpp"

namespace undula::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string number_or(double value, const std::string& otherwise) {
  return std::isfinite(value) ? plain_number(value) : otherwise;
}

/// Name of the data without folders.
std::string short_name(const TargetCurve& target) {
  return std::filesystem::path(target.name).filename().string();
}

std::string key_table(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    const FreeKey& key = report.keys[i];
    const auto at = static_cast<Eigen::Index>(i);
    rows.push_back({key.key,
                    key.prior_deviation > 0 ? plain_number(key.prior_value) + " -+ " +
                                                  plain_number(key.prior_deviation * deviations_of_95_percent)
                                            : plain_number(key.low) + " to " + plain_number(key.high),
                    plain_number(calibration.start[at]), plain_number(calibration.optimum[at]),
                    number_or(calibration.identified.standard_error[at], "not fixed"),
                    calibration.at_bound[i] ? "yes" : "no"});
  }
  return text_table({"key", "range", "start", "optimum", "standard error", "at bound"}, rows);
}

std::string curve_table(const CalibrationReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    const CalibratedCurve& curve = report.calibration.curves[c];
    rows.push_back({short_name(report.targets[c]), decimals(curve.start_rms_l_per_min, 4),
                    decimals(curve.optimum_rms_l_per_min, 4),
                    decimals(report.targets[c].scatter_l_per_min, 4)});
  }
  return text_table({"data", "rms before (l/min)", "rms after (l/min)", "scatter of the data (l/min)"}, rows);
}

/// Mean over the heads of a curve, l/min per unit of key i.
double mean_sensitivity(const CalibratedCurve& curve, std::size_t i) {
  return curve.sensitivity.col(static_cast<Eigen::Index>(i)).mean();
}

std::string sensitivity_table(const CalibrationReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    for (std::size_t i = 0; i < report.keys.size(); ++i) {
      const FreeKey& key = report.keys[i];
      const double mean = mean_sensitivity(report.calibration.curves[c], i);
      rows.push_back({short_name(report.targets[c]), key.key, plain_number(mean),
                      plain_number(mean * (key.high - key.low))});
    }
  }
  return text_table(
      {"data", "key", "mean dQ/dkey (l/min per unit of the key)", "over the range of the key (l/min)"}, rows);
}

std::string profile_table(const CalibrationReport& report, const KeyProfile& profile) {
  std::vector<std::string> header = {profile.key, "misfit"};
  for (const TargetCurve& target : report.targets) {
    header.push_back(setting_text(target) + ", rms (l/min)");
  }
  for (const FreeKey& key : report.keys) {
    if (key.key != profile.key) {
      header.push_back(key.key);
    }
  }
  std::vector<std::vector<std::string>> rows;
  for (const ProfilePoint& point : profile.points) {
    rows.push_back({plain_number(point.value), point.computed ? decimals(point.misfit, 2) : "failed"});
    for (const double rms : point.rms_l_per_min) {
      rows.back().push_back(decimals(rms, 4));
    }
    for (const double value : point.others) {
      rows.back().push_back(plain_number(value));
    }
    rows.back().resize(header.size(), "-");
  }
  return text_table(header, rows);
}

std::string correlation_table(const CalibrationReport& report) {
  std::vector<std::string> header = {"correlation"};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    header.push_back(report.keys[i].key);
    rows.push_back({report.keys[i].key});
    for (std::size_t j = 0; j < report.keys.size(); ++j) {
      const double value = report.calibration.identified.correlation(static_cast<Eigen::Index>(i),
                                                                     static_cast<Eigen::Index>(j));
      rows.back().push_back(std::isfinite(value) ? decimals(value, 3) : "-");
    }
  }
  return text_table(header, rows);
}

/// What has to be known before the numbers are believed.
std::vector<std::string> statements(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  auto all = identifiability_statements(report.keys, calibration.identified);
  if (all.empty()) {
    all.emplace_back("the data fix every free key");
  }
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    if (calibration.at_bound[i]) {
      all.push_back(report.keys[i].key +
                    " is at an end of its range: the least squares may lie beyond, and its standard error "
                    "is that of a fit without bounds");
    }
  }
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    const double rms = calibration.curves[c].optimum_rms_l_per_min;
    if (rms > report.targets[c].scatter_l_per_min && rms > flow_noise_l_per_min) {
      all.push_back(short_name(report.targets[c]) +
                    ": the residual is larger than the scatter of the data, so it is "
                    "the model's; the standard errors know nothing of it");
    }
  }
  if (!calibration.converged) {
    all.emplace_back("the search ended at its limit of points, before its steps were short");
  }
  if (calibration.refused > 0) {
    all.push_back("refused " + std::to_string(calibration.refused) +
                  " sets of values, where a flow could not be computed");
  }
  return all;
}

std::string join(const Eigen::VectorXd& values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ", ") + plain_number(value);
  }
  return text;
}

/// Values with null for what is not finite.
Json json_list(const Eigen::VectorXd& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(finite_or_null(value));
  }
  return list;
}

Json json_rows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(json_list(matrix.row(i)));
  }
  return rows;
}

std::string point_line(double flow, double head) {
  return exact_number(flow) + " " + exact_number(head) + "\n";
}

} // namespace

std::string calibration_table(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  std::string text =
      key_table(report) + "\n" + curve_table(report) + "\n" + sensitivity_table(report) + "\n" +
      correlation_table(report) +
      "singular values of the Jacobian per range (l/min): " + join(calibration.identified.singular_values) +
      "; condition " + number_or(calibration.identified.condition, "infinite") + "\n\n";
  for (const std::string& statement : statements(report)) {
    text += "- " + statement + "\n";
  }
  for (const KeyProfile& profile : report.profiles) {
    text += "\nprofile, best misfit of the whole fit " + decimals(calibration.misfit, 2) + ":\n" +
            profile_table(report, profile);
  }
  const auto curves = static_cast<std::size_t>(calibration.points) * report.targets.size();
  return text + "\n" + std::to_string(curves) + " curves in " + decimals(calibration.seconds, 1) + " s\n";
}

std::string calibration_json(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  const Identifiability& identified = calibration.identified;
  Json result = {{"scene", report.scene.name},
                 {"converged", calibration.converged},
                 {"curves_computed", static_cast<std::size_t>(calibration.points) * report.targets.size()},
                 {"refused", calibration.refused},
                 {"seconds", calibration.seconds},
                 {"keys", Json::array()},
                 {"curves", Json::array()}};
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    const FreeKey& key = report.keys[i];
    const auto at = static_cast<Eigen::Index>(i);
    result["keys"].push_back({{"key", key.key},
                              {"low", key.low},
                              {"high", key.high},
                              {"start", calibration.start[at]},
                              {"optimum", calibration.optimum[at]},
                              {"at_bound", static_cast<bool>(calibration.at_bound[i])},
                              {"standard_error", finite_or_null(identified.standard_error[at])},
                              {"influence_l_per_min", identified.influence[at]}});
  }
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    const TargetCurve& target = report.targets[c];
    const CalibratedCurve& curve = calibration.curves[c];
    Json sensitivity = Json::array();
    for (std::size_t i = 0; i < report.keys.size(); ++i) {
      const double mean = mean_sensitivity(curve, i);
      sensitivity.push_back(
          {{"key", report.keys[i].key},
           {"mean_l_per_min_per_unit", mean},
           {"mean_l_per_min_per_range", mean * (report.keys[i].high - report.keys[i].low)},
           {"l_per_min_per_unit", json_list(curve.sensitivity.col(static_cast<Eigen::Index>(i)))}});
    }
    result["curves"].push_back({{"data", target.name},
                                {"frequency_Hz", target.frequency_Hz},
                                {target.voltage_V > 0 ? "voltage_V" : "stroke_mm",
                                 target.voltage_V > 0 ? target.voltage_V : target.stroke_mm},
                                {"head_mmHg", target.head_mmHg},
                                {"measured_l_per_min", target.flow_l_per_min},
                                {"start_l_per_min", curve.start_l_per_min},
                                {"optimum_l_per_min", curve.optimum_l_per_min},
                                {"rms_before_l_per_min", curve.start_rms_l_per_min},
                                {"rms_after_l_per_min", curve.optimum_rms_l_per_min},
                                {"scatter_l_per_min", target.scatter_l_per_min},
                                {"sensitivity", sensitivity}});
  }
  result["correlation"] = json_rows(identified.correlation);
  result["singular_values_l_per_min"] = json_list(identified.singular_values);
  result["condition"] = finite_or_null(identified.condition);
  result["directions"] = json_rows(identified.directions.transpose());
  result["direction_errors"] = json_list(identified.direction_error);
  result["misfit"] = calibration.misfit;
  result["profiles"] = Json::array();
  for (const KeyProfile& profile : report.profiles) {
    Json points = Json::array();
    for (const ProfilePoint& point : profile.points) {
      points.push_back({{"value", point.value},
                        {"misfit", point.computed ? Json(point.misfit) : Json(nullptr)},
                        {"rms_l_per_min", point.rms_l_per_min},
                        {"others", json_list(point.others)}});
    }
    result["profiles"].push_back({{"key", profile.key}, {"points", points}});
  }
  result["statements"] = statements(report);
  return result.dump(2) + "\n";
}

std::string calibrated_scene_text(const CalibrationReport& report, const std::filesystem::path& folder) {
  Scene scene = report.scene;
  // Links are followed first: the way back by ".." starts at the folder itself.
  const auto start = std::filesystem::weakly_canonical(std::filesystem::absolute(folder));
  const auto relative = [&](std::filesystem::path& file) {
    if (!file.empty()) {
      file = std::filesystem::weakly_canonical(std::filesystem::absolute(file)).lexically_proximate(start);
    }
  };
  relative(scene.profile);
  relative(scene.fluid_mesh);
  for (auto& mesh : scene.solid_meshes) {
    relative(mesh);
  }
  std::string text =
      "# Calibrated by `undula calibrate` from " + report.scene.file.filename().string() + ".\n";
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    const TargetCurve& target = report.targets[c];
    const CalibratedCurve& curve = report.calibration.curves[c];
    text += "# data: " + short_name(target) + " (" + setting_text(target) + ") at " +
            std::to_string(target.head_mmHg.size()) + " heads from " +
            plain_number(target.head_mmHg.front()) + " to " + plain_number(target.head_mmHg.back()) +
            " mmHg; rms of computed - measured " + decimals(curve.start_rms_l_per_min, 4) +
            " l/min before, " + decimals(curve.optimum_rms_l_per_min, 4) + " after; scatter of the data " +
            decimals(target.scatter_l_per_min, 4) + "\n";
  }
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    const FreeKey& key = report.keys[i];
    const auto at = static_cast<Eigen::Index>(i);
    text += "# free: " + key.key + " in " + plain_number(key.low) + " to " + plain_number(key.high) +
            (key.prior_deviation > 0 ? ", held by its tolerance" : "") + ", from " +
            plain_number(report.calibration.start[at]) + " to " +
            plain_number(report.calibration.optimum[at]) + ", standard error " +
            number_or(report.calibration.identified.standard_error[at], "not fixed by the data") +
            (report.calibration.at_bound[i] ? ", at an end of its range" : "") + "\n";
  }
  return text + "# Tolerances are those of the scene before.\n\n" + scene_to_toml(scene);
}

bool plot_calibration(const std::filesystem::path& picture, const CalibrationReport& report,
                      std::span<const MeasuredCurve> measured) {
  constexpr std::array colours = {"#1f4e8c", "#c0392b", "#27853f", "#8e44ad"};
  std::string data, items;
  int block = 0;
  const auto add = [&](std::span<const double> flow, std::span<const double> head, const std::string& style,
                       const std::string& label) {
    data += std::string(block == 0 ? "" : "\n\n") + "# flow (l/min), head (mmHg): " + label + "\n";
    for (std::size_t i = 0; i < flow.size(); ++i) {
      data += point_line(flow[i], head[i]);
    }
    items += std::string(block == 0 ? "plot" : ",") + " \\\n  data index " + std::to_string(block) +
             " with " + style + " title " + gnuplot_string(label);
    ++block;
  };
  for (std::size_t c = 0; c < report.targets.size(); ++c) {
    const TargetCurve& target = report.targets[c];
    const CalibratedCurve& curve = report.calibration.curves[c];
    const std::string colour = std::string(" lc rgb '") + colours[c % colours.size()] + "'";
    const std::string at = setting_text(target);
    add(measured[c].flow_l_per_min, measured[c].head_mmHg, "points pt 6 ps 0.7" + colour, at + ", measured");
    add(curve.start_l_per_min, target.head_mmHg, "lines dt 2 lw 1.5" + colour, at + ", before");
    add(curve.optimum_l_per_min, target.head_mmHg, "linespoints pt 7 ps 0.8 lw 2" + colour,
        at + ", calibrated");
  }
  return draw_picture(picture, data,
                      "set title " + gnuplot_string("Calibration of " + report.scene.name) +
                          "\nset xlabel 'flow (l/min)'\nset ylabel 'head (mmHg)'\nset grid\n"
                          "set key bottom left\n" +
                          items + "\n");
}

} // namespace undula::apps
