// Measured curves, lists of heads, the benchmark's comparison.
#include "apps/input/measured_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "apps/apps.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/validation.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

const std::string shipped = UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv";

TEST(MeasuredCurve, TheFitOfTheShippedDataIsTheReference) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  EXPECT_NEAR(curve.fit.coefficients[0], 5.92517, 1e-5);
  EXPECT_NEAR(curve.fit.coefficients[1], -0.018991, 1e-6);
  EXPECT_NEAR(curve.fit.coefficients[2], -1.2321e-3, 1e-7);
  EXPECT_NEAR(curve.fit.scatter_l_per_min, 0.095, 5e-4); // as the headers of the data state
  EXPECT_NEAR(
      read_measured_curve(UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.63mm.csv").fit.scatter_l_per_min,
      0.098, 5e-4);
  EXPECT_NEAR(curve.fit(55), 1.15, 5e-3);
}

TEST(MeasuredCurve, AParabolaIsFittedExactly) {
  std::vector<double> head, flow;
  for (int i = 0; i < 7; ++i) {
    head.push_back(1000 + 3 * i); // far from zero: the fit has to be well conditioned
    flow.push_back(2 - 0.5 * head.back() + 1e-3 * head.back() * head.back());
  }
  const QuadraticFit fit = fit_quadratic(head, flow);
  EXPECT_NEAR(fit.coefficients[2], 1e-3, 1e-12);
  EXPECT_NEAR(fit.coefficients[1], -0.5, 1e-9);
  EXPECT_NEAR(fit.coefficients[0], 2, 1e-6);
  EXPECT_LT(fit.scatter_l_per_min, 1e-10);
}

TEST(MeasuredCurve, SamplesAreSortedAndSpacesCommentsAndWindowsLineEndsAreRead) {
  const ScratchFolder folder;
  const auto file = folder.path() / "data.csv";
  std::ofstream(file)
      << "# a comment\r\n\r\nhead_mmHg,flow_l_per_min\r\n60, 1\r\n40,3\r\n# between\r\n 50 ,2.5\r\n40,2\r\n";
  const MeasuredCurve curve = read_measured_curve(file);
  EXPECT_EQ(curve.head_mmHg, (std::vector<double>{40, 40, 50, 60}));
  EXPECT_EQ(curve.flow_l_per_min, (std::vector<double>{2, 3, 2.5, 1}));
}

TEST(MeasuredCurve, FrequencyAndStrokeAreReadWhereTheFileStatesThem) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  EXPECT_EQ(curve.frequency_Hz, 120);
  EXPECT_EQ(curve.stroke_mm, 0.53);
  const ScratchFolder folder;
  const auto file = folder.path() / "data.csv";
  std::ofstream(file) << "# remark = 3\n#stroke_mm=0.4 \nhead_mmHg,flow_l_per_min\n# frequency_Hz = 90\n"
                         "60,1\n50,2\n40,3\n";
  EXPECT_EQ(read_measured_curve(file).stroke_mm, 0.4);
  EXPECT_FALSE(read_measured_curve(file).frequency_Hz); // only the lines before the columns count
  std::ofstream(file) << "# stroke_mm = 0.4\n# stroke_mm = 0.5\nhead_mmHg,flow_l_per_min\n60,1\n50,2\n40,3\n";
  EXPECT_THROW(read_measured_curve(file), InputError);
}

TEST(MeasuredCurve, WhatSpreadsheetsWriteIsRead) {
  const ScratchFolder folder;
  const auto file = folder.path() / "data.csv";
  const std::string plain = "# stroke_mm: 0.4\nhead_mmHg,flow_l_per_min\n40,3\n50,2\n60,0.3\n";
  const auto as_utf16 = [&](bool little) {
    std::string bytes = little ? "\xff\xfe" : "\xfe\xff";
    for (const char c : plain) {
      bytes += little ? std::string{c, '\0'} : std::string{'\0', c};
    }
    return bytes;
  };
  const std::vector<std::string> ways = {
      plain,
      "\xef\xbb\xbf" + plain,
      as_utf16(true),
      as_utf16(false),
      "# stroke_mm = 0.4\r\n\"head_mmHg\",\"flow_l_per_min\"\r\n\"40\",\"3\"\r\n\"50\",2\r\n60,\"0.3\"\r\n",
      "# stroke_mm = +0.4\nhead_mmHg,flow_l_per_min\n40,+3\n+50,2\n60,0.3\n",
      "# stroke_mm = 0.4\n,\nhead_mmHg,flow_l_per_min\n,\n40,3\n50,2\n\"\",\"\"\n60,0.3\n,\n,\n"};
  for (const std::string& bytes : ways) {
    std::ofstream(file, std::ios::binary) << bytes;
    const MeasuredCurve curve = read_measured_curve(file);
    EXPECT_EQ(curve.head_mmHg, (std::vector<double>{40, 50, 60})) << bytes;
    EXPECT_EQ(curve.flow_l_per_min, (std::vector<double>{3, 2, 0.3})) << bytes;
    EXPECT_EQ(curve.stroke_mm, 0.4) << bytes;
  }
  for (const char* row : {"40,+-3", "40,\"3", "40,++3", "40;3", "40,"}) {
    std::ofstream(file, std::ios::binary) << plain << row << "\n";
    EXPECT_THROW(read_measured_curve(file), InputError) << row;
  }
}

TEST(MeasuredCurve, AnotherOperatingPointIsTold) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  const auto told = [](const MeasuredCurve& of, double frequency_Hz, double stroke_mm) {
    OperatingPoint point;
    point.frequency = frequency_Hz;
    point.stroke = units::length_from_mm(stroke_mm);
    return other_operating_point(of, "a.csv", "the model", point);
  };
  EXPECT_EQ(told(curve, 120, 0.53), "");
  EXPECT_EQ(
      told(curve, 100, 0.53),
      "a.csv was measured at another operating point: 120 Hz, stroke 0.53 mm; the model has 100 Hz, stroke "
      "0.53 mm");
  EXPECT_NE(told(curve, 120, 0.63), "");
  MeasuredCurve bare = curve;
  bare.frequency_Hz.reset();
  bare.stroke_mm.reset();
  EXPECT_EQ(told(bare, 100, 0.1), "");
}

// With a voltage the nominal stroke does not count.
TEST(MeasuredCurve, AnotherVoltageIsTold) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  EXPECT_EQ(curve.voltage_V, 40);
  OperatingPoint point;
  point.frequency = 120;
  point.drive = Drive::voltage;
  point.voltage = 40;
  EXPECT_EQ(other_operating_point(curve, "a.csv", "the scene", point), "");
  point.voltage = 45;
  EXPECT_EQ(other_operating_point(curve, "a.csv", "the scene", point),
            "a.csv was measured at another operating point: 120 Hz, 40 V; the scene has 120 Hz, 45 V");
}

TEST(MeasuredCurve, ExtractionGivesTheFitAndTheNearestSample) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  const std::vector<double> heads = {50};
  const auto points = extract_points(curve, heads);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_DOUBLE_EQ(points[0].nearest_head_mmHg, 50.002);
  EXPECT_DOUBLE_EQ(points[0].nearest_l_per_min, 1.834);
  EXPECT_NEAR(points[0].fit_l_per_min, 1.90, 5e-3);
  const std::vector<double> outside = {50, 80};
  EXPECT_THROW(extract_points(curve, outside), InputError);
}

TEST(Validation, TheNormIsTheTwoNormOfTheDifferences) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  const std::vector<double> heads = {50, 55, 60};
  const std::vector<double> flows = {curve.fit(50) + 0.3, curve.fit(55) - 0.4, curve.fit(60)};
  const Validation shifted = validate(curve, heads, flows);
  EXPECT_NEAR(shifted.norm_to_fit_l_per_min, 0.5, 1e-12);
  EXPECT_NEAR(shifted.points[1].computed_l_per_min, curve.fit(55) - 0.4, 1e-15);

  std::vector<double> near_samples;
  for (const ExtractedPoint& point : extract_points(curve, heads)) {
    near_samples.push_back(point.nearest_l_per_min + 0.1);
  }
  EXPECT_NEAR(validate(curve, heads, near_samples).norm_to_nearest_l_per_min, 0.1 * std::sqrt(3.0), 1e-12);
}

TEST(Validation, AHeadOutsideTheDataIsRefused) {
  const MeasuredCurve curve = read_measured_curve(shipped);
  const std::vector<double> heads = {50, 90}, flows = {0, 0};
  EXPECT_THROW(validate(curve, heads, flows), InputError);
}

TEST(HeadList, RangesIncludeTheirEndAndMixWithValues) {
  EXPECT_EQ(parse_heads("40:62:2").size(), 12u);
  EXPECT_DOUBLE_EQ(parse_heads("40:62:2").back(), 62);
  EXPECT_EQ(parse_heads("50"), (std::vector<double>{50}));
  EXPECT_EQ(parse_heads("-5,50.5,0"), (std::vector<double>{-5, 50.5, 0}));
  EXPECT_EQ(parse_heads("60:50:-5,40"), (std::vector<double>{60, 55, 50, 40}));
  EXPECT_EQ(parse_heads("0:1:0.1").size(), 11u); // 0.1 is not exact in binary
  EXPECT_EQ(parse_heads("0:1:0.4"), (std::vector<double>{0, 0.4, 0.8}));
  EXPECT_EQ(even_heads(0, 70, 8), (std::vector<double>{0, 10, 20, 30, 40, 50, 60, 70}));
  EXPECT_EQ(even_heads(40, 60, 1), (std::vector<double>{50}));
}

TEST(Progress, TheLineEstimatesTheTimeLeft) {
  EXPECT_EQ(progress_line("solve", 0, 10, 5), "solve  0 %  0/10");
  EXPECT_EQ(progress_line("solve", 1, 3, 60), "solve  33 %  1/3  2:00 left");
  EXPECT_EQ(progress_line("solve", 1, 100, 60), "solve  1 %  1/100  1:39:00 left");
  EXPECT_EQ(progress_line("solve", 3, 3, 60), "solve  100 %  3/3");
  EXPECT_EQ(progress_json("a \"b\"", 1, 3, 60),
            R"({"progress":"a \"b\"","done":1,"total":3,"seconds_left":120})");
  EXPECT_EQ(progress_json("solve", 3, 3, 60),
            R"({"progress":"solve","done":3,"total":3,"seconds_left":null})");
}

TEST(TextTable, ColumnsAreAligned) {
  EXPECT_EQ(text_table({"a", "bb"}, {{"long", "1"}, {"x", "222"}}), "a      bb\nlong    1\nx     222\n");
  EXPECT_EQ(decimals(1.2345, 2), "1.23");
  EXPECT_EQ(plain_number(0.53), "0.53");
}

} // namespace
} // namespace undula::apps
