#include "apps/output/level_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/output/curve_report.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/label_places.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

std::string number(double value, int digits) { return std::isfinite(value) ? decimals(value, digits) : "-"; }

CurveDifference to_reference(const LevelReport& report, const LevelResult& result) {
  if (result.reference < 0) {
    return {std::nan(""), std::nan(""), 0};
  }
  return curve_difference(result.flow, report.results[static_cast<std::size_t>(result.reference)].flow);
}

/// Of a logarithmic axis, with room around the values of one column and `also`, where that is positive.
std::pair<double, double> range_of(const std::vector<std::array<double, 2>>& places, std::size_t column,
                                   double also) {
  double low = also > 0 ? also : places.front()[column], high = low;
  for (const auto& place : places) {
    low = std::min(low, place[column]);
    high = std::max(high, place[column]);
  }
  constexpr double room = 5;
  return {low / room, high * room};
}

} // namespace

CurveDifference curve_difference(std::span<const double> a, std::span<const double> b) {
  CurveDifference difference;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(a[i] - b[i]);
    if (std::isfinite(d)) {
      squares += d * d;
      difference.largest = std::max(difference.largest, d);
      ++difference.points;
    }
  }
  if (difference.points == 0) {
    return {std::nan(""), std::nan(""), 0};
  }
  difference.rms = std::sqrt(squares / difference.points);
  return difference;
}

std::string level_report_table(const LevelReport& report) {
  std::vector<std::vector<std::string>> rows;
  int index = 1;
  for (const LevelResult& result : report.results) {
    const CurveDifference data = curve_difference(result.flow, report.measured);
    rows.push_back({std::to_string(index++) + " " + result.level, result.source,
                    std::to_string(result.unknowns), plain_number(result.seconds_per_point),
                    number(data.rms, 3), number(data.largest, 3), number(to_reference(report, result).rms, 3),
                    result.reference < 0 ? "-" : std::to_string(result.reference + 1)});
  }
  return text_table({"level", "source", "unknowns", "s per point", "rms to data (l/min)", "largest (l/min)",
                     "rms to reference (l/min)", "reference"},
                    rows) +
         "data: " + report.data_file + ", scatter " + decimals(report.scatter_l_per_min, 3) +
         " l/min about its fit; " + std::to_string(report.head_mmHg.size()) + " heads from " +
         plain_number(report.head_mmHg.front()) + " to " + plain_number(report.head_mmHg.back()) + " mmHg\n";
}

std::string level_report_json(const LevelReport& report) {
  nlohmann::ordered_json json = {{"data", report.data_file},
                                 {"frequency_Hz", report.frequency_Hz},
                                 {"stroke_mm", report.stroke_mm},
                                 {"scatter_l_per_min", report.scatter_l_per_min},
                                 {"head_mmHg", report.head_mmHg},
                                 {"measured_l_per_min", report.measured},
                                 {"levels", nlohmann::ordered_json::array()}};
  for (const LevelResult& result : report.results) {
    const CurveDifference data = curve_difference(result.flow, report.measured);
    nlohmann::ordered_json flow = nlohmann::ordered_json::array();
    for (const double q : result.flow) {
      flow.push_back(finite_or_null(q));
    }
    json["levels"].push_back(
        {{"level", result.level},
         {"source", result.source},
         {"unknowns", result.unknowns},
         {"seconds_per_point", result.seconds_per_point},
         {"flow_l_per_min", flow},
         {"rms_to_data_l_per_min", finite_or_null(data.rms)},
         {"largest_to_data_l_per_min", finite_or_null(data.largest)},
         {"rms_to_reference_l_per_min", finite_or_null(to_reference(report, result).rms)},
         {"reference",
          result.reference < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(result.reference)}});
  }
  return json.dump(2) + "\n";
}

bool plot_level_report(const std::filesystem::path& picture, const LevelReport& report) {
  // One block of the data file per level, so that each has its mark.
  std::map<std::string, std::string> blocks;
  std::vector<std::array<double, 2>> places; // seconds, error
  std::vector<LabelledMark> marks;
  int index = 1;
  for (const LevelResult& result : report.results) {
    const CurveDifference data = curve_difference(result.flow, report.measured);
    // Logarithmic axes have no place for 0.
    if (data.points > 0 && data.rms > 0 && result.seconds_per_point > 0) {
      blocks[result.level] += plain_number(result.seconds_per_point) + " " + plain_number(data.rms) + "\n";
      places.push_back({result.seconds_per_point, data.rms});
      marks.push_back({0, 0, std::to_string(index)});
    }
    ++index;
  }
  if (blocks.empty()) {
    return false;
  }
  // Both axes are logarithmic; the picture holds about this many columns and lines of text.
  constexpr std::array<double, 2> extent = {62, 28};
  const std::array<std::pair<double, double>, 2> ranges = {range_of(places, 0, 0),
                                                           range_of(places, 1, report.scatter_l_per_min)};
  const auto part = [&](std::size_t axis, double value) {
    return std::log(value / ranges[axis].first) / std::log(ranges[axis].second / ranges[axis].first);
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    marks[i].x = extent[0] * part(0, places[i][0]);
    marks[i].y = extent[1] * part(1, places[i][1]);
  }
  const auto offsets = label_offsets(marks);
  std::string labels;
  for (std::size_t i = 0; i < places.size(); ++i) {
    labels += "set label " + gnuplot_string(marks[i].text) + " at " + plain_number(places[i][0]) + "," +
              plain_number(places[i][1]) + " center offset " + plain_number(offsets[i].first) + "," +
              plain_number(offsets[i].second) + "\n";
  }
  std::string data, items;
  int block = 0;
  for (const auto& [level, lines] : blocks) {
    data += (block == 0 ? "" : "\n\n") + lines;
    items += "data index " + std::to_string(block) + " using 1:2 with points pt 7 ps 1.5 lc " +
             std::to_string(block + 1) + " title " + gnuplot_string(level) + ", \\\n  ";
    ++block;
  }
  const std::string scatter = plain_number(report.scatter_l_per_min);
  const std::string title = "Speed against error: " + plain_number(report.frequency_Hz) + " Hz, stroke " +
                            plain_number(report.stroke_mm) + " mm";
  const auto range_text = [&](std::size_t axis) {
    return "[" + plain_number(ranges[axis].first) + ":" + plain_number(ranges[axis].second) + "]\n";
  };
  return draw_picture(picture, data,
                      "set title " + gnuplot_string(title) +
                          "\nset xlabel 'seconds per operating point'"
                          "\nset ylabel 'rms error of the flow against the data (l/min)'"
                          "\nset logscale xy\nset grid\nset key outside right top\nset xrange " +
                          range_text(0) + "set yrange " + range_text(1) + labels + "plot \\\n  " + items +
                          scatter + " with lines dt 2 lc rgb 'gray' title 'scatter of the data'\n");
}

} // namespace undula::apps
