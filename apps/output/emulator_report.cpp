#include "apps/output/emulator_report.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

using training::BuiltEmulator;
using training::EmulatorScore;

std::string score_text(const char* what, const EmulatorScore& score, double range) {
  if (score.runs == 0) {
    return "";
  }
  return std::string(what) + ", " + std::to_string(score.runs) + " runs: rms " + decimals(score.rms, 4) +
         " l/min (" + decimals(100 * score.rms / range, 2) + " % of the range), worst " +
         decimals(score.worst, 4) + ", " + decimals(100 * score.covered, 0) +
         " % within the stated error, which is " + decimals(score.error_over_true, 1) +
         " times the true one in the median\n";
}

nlohmann::ordered_json score_json(const EmulatorScore& score) {
  return {{"runs", score.runs},
          {"rms_l_per_min", score.rms},
          {"worst_l_per_min", score.worst},
          {"covered", score.covered},
          {"stated_over_true_median", score.error_over_true}};
}

} // namespace

std::string emulator_text(const BuiltEmulator& built, const std::string& file) {
  const auto& emulator = built.emulator;
  std::vector<std::string> heads = {
      "run", "f (Hz)", emulator.driven_by_voltage ? "voltage (V)" : "stroke (mm)", "head (mmHg)"};
  for (const auto& input : further_inputs(emulator)) {
    heads.push_back(input.name);
  }
  for (const char* name :
       {"flow (l/min)", "standard error", "emulated without it", "stated error", "run (s)"}) {
    heads.emplace_back(name);
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& run : emulator.runs) {
    std::vector<std::string> row = {run.held_out ? "held out" : "training", plain_number(run.point[0]),
                                    decimals(run.point[1], 3), decimals(run.point[2], 2)};
    for (std::size_t i = rom::point_inputs; i < run.point.size(); ++i) {
      row.push_back(plain_number(run.point[i]));
    }
    for (const auto& [value, digits] :
         {std::pair(run.flow_l_per_min, 4), std::pair(run.standard_error_l_per_min, 4),
          std::pair(run.emulated_l_per_min, 4), std::pair(run.stated_error_l_per_min, 4),
          std::pair(run.seconds, 1)}) {
      row.push_back(decimals(value, digits));
    }
    rows.push_back(std::move(row));
  }
  std::string text = text_table(heads, rows);
  text += score_text("\nleft out one by one", built.left_out, built.flow_range);
  text += score_text("held out", built.held_out, built.flow_range);
  for (const auto& response : built.responses) {
    text += "over a period, " + response.name + ": " + std::to_string(response.modes) +
            " modes; left out one by one off by " + decimals(100 * response.left_out, 2) +
            " % of their size, the envelope by " + decimals(100 * response.envelope, 2) + " %";
    if (response.held_out > 0) {
      text += "; held out by " + decimals(100 * response.held_out, 2) + " and " +
              decimals(100 * response.envelope_held_out, 2) + " %";
    }
    text += "\n";
  }
  return text + "quantities: " + std::to_string(emulator.quantities.size()) + "\nwritten: " + file + "\n";
}

std::string emulator_json(const BuiltEmulator& built, const std::string& file) {
  nlohmann::ordered_json result = {{"emulator", file},
                                   {"flow_range_l_per_min", built.flow_range},
                                   {"left_out", score_json(built.left_out)},
                                   {"held_out", score_json(built.held_out)},
                                   {"not_used", built.not_used},
                                   {"quantities", nlohmann::ordered_json::array()},
                                   {"runs", nlohmann::ordered_json::array()}};
  for (const auto& response : built.responses) {
    result["responses"].push_back({{"name", response.name},
                                   {"modes", response.modes},
                                   {"left_out", response.left_out},
                                   {"held_out", response.held_out},
                                   {"envelope_left_out", response.envelope},
                                   {"envelope_held_out", response.envelope_held_out}});
  }
  for (const auto& quantity : built.emulator.quantities) {
    result["quantities"].push_back(quantity.name);
  }
  for (const auto& run : built.emulator.runs) {
    nlohmann::ordered_json row = {
        {"held_out", run.held_out},
        {"frequency_Hz", run.point[0]},
        {built.emulator.driven_by_voltage ? "voltage_V" : "stroke_mm", run.point[1]},
        {"head_mmHg", run.point[2]}};
    for (std::size_t i = rom::point_inputs; i < run.point.size(); ++i) {
      row[built.emulator.inputs[i].name] = run.point[i];
    }
    row.update({{"flow_l_per_min", run.flow_l_per_min},
                {"standard_error_l_per_min", run.standard_error_l_per_min},
                {"emulated_l_per_min", run.emulated_l_per_min},
                {"stated_error_l_per_min", run.stated_error_l_per_min},
                {"seconds", run.seconds}});
    result["runs"].push_back(std::move(row));
  }
  return result.dump(2) + "\n";
}

} // namespace undula::apps
