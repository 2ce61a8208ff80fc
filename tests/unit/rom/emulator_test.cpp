// Emulators: what they say inside, at and beyond their box, and their file.
#include "rom/emulator/emulator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"

namespace undula::rom {
namespace {

/// Flow = 5 - 0.1 (head - 40) + 0.05 (drive - 40) at 120 Hz, on a grid.
Emulator linear_emulator() {
  Eigen::MatrixXd points(2, 16);
  Eigen::VectorXd flows(16);
  for (int i = 0; i < 16; ++i) {
    points.col(i) << (i % 4) / 3.0, (i / 4) / 3.0;
    flows[i] = 5 - 0.1 * 40 * (points(1, i) - 0.5) + 0.05 * 20 * (points(0, i) - 0.5);
  }
  Emulator emulator;
  emulator.driven_by_voltage = true;
  emulator.inputs = {
      EmulatorInput{"frequency", "Hz", 120, 120}, {"voltage", "V", 30, 50}, {"head", "mmHg", 20, 60}};
  const ProcessParameters parameters{Eigen::Vector2d(1, 1), 0.2, 1e-4};
  emulator.quantities.push_back(
      {"flow_l_per_min", "l/min", {points, flows, Eigen::VectorXd::Constant(16, 0.01), parameters}, 1.7});
  emulator.quantities.push_back(
      {"power_mW", "mW", {points, 100 * flows, Eigen::VectorXd::Zero(16), {parameters.lengths, 2e3, 1}}, 2});
  emulator.runs = {{{120, 30, 20}, 6.5, 0.02, false, 6.4, 0.1, 300},
                   {{120, 45, 30}, 6, 0, true, 6.1, 0.2, 200}};
  emulator.provenance = {{"scene", "name = \"x\"\n"}, {"commit", "abc"}};
  return emulator;
}

TEST(Emulator, AnswersInSurfaceUnitsAndDoubtsWhatIsOutside) {
  const auto emulator = linear_emulator();
  const auto inside = emulate(emulator, {120, 45, 30});
  EXPECT_NEAR(inside.values[0].value, 5 + 1 + 0.25, 1e-6);
  EXPECT_NEAR(inside.values[1].value, 625, 1e-3);
  EXPECT_TRUE(inside.inside_training_box);
  EXPECT_GT(inside.values[0].error, 0);
  const auto near = emulate(emulator, {120, 45, 62});
  EXPECT_FALSE(near.inside_training_box);
  EXPECT_GT(near.values[0].error, 2 * inside.values[0].error);
  EXPECT_TRUE(std::isfinite(near.values[0].error));
  EXPECT_TRUE(std::isinf(emulate(emulator, {120, 45, 90}).values[0].error));
  EXPECT_TRUE(std::isinf(emulate(emulator, {110, 45, 30}).values[0].error)); // no run at another frequency
}

/// The same with a modulus that moves the flow by 2 l/min over its range.
Emulator with_modulus() {
  auto emulator = linear_emulator();
  emulator.inputs.push_back({"membrane.young_dyn_per_cm2", "dyn_per_cm2", 1e7, 2e7, 1.5e7});
  emulator.force_N_per_V = 0.4;
  emulator.quantities.pop_back();
  Eigen::MatrixXd points(3, 64);
  Eigen::VectorXd flows(64);
  for (int i = 0; i < 64; ++i) {
    points.col(i) << (i % 4) / 3.0, (i / 4 % 4) / 3.0, (i / 16) / 3.0;
    flows[i] = 5 - 4 * (points(1, i) - 0.5) + (points(0, i) - 0.5) + 2 * (points(2, i) - 0.5);
  }
  emulator.quantities[0].process = {
      points, flows, Eigen::VectorXd::Constant(64, 0.01), {Eigen::Vector3d(1, 1, 1), 0.2, 1e-4}};
  for (auto& run : emulator.runs) run.point.push_back(1.2e7);
  EmulatedResponse response{"outflow_l_per_min", "l/min", {0}, 4, Eigen::Vector4d(1, 2, 3, 2), {}, {}, 0.3};
  response.modes = Eigen::Vector4d(0.5, -0.5, 0.5, -0.5);
  response.coefficients.push_back(emulator.quantities[0].process);
  emulator.responses.push_back(std::move(response));
  return emulator;
}

TEST(Emulator, FurtherInputsAreAsStatedUnlessTheyAreGiven) {
  const auto emulator = with_modulus();
  const double stated = emulate(emulator, {120, 45, 30}).values[0].value;
  EXPECT_EQ(emulate(emulator, {120, 45, 30, 1.5e7}).values[0].value, stated);
  EXPECT_NEAR(emulate(emulator, {120, 45, 30, 1.75e7}).values[0].value, stated + 0.5, 1e-3);
  const auto outside = emulate(emulator, {120, 45, 30, 2.1e7});
  EXPECT_FALSE(outside.inside_training_box);
  EXPECT_GT(outside.values[0].error, 2 * emulate(emulator, {120, 45, 30, 2e7}).values[0].error);
}

class EmulatorFile : public testing::Test {
protected:
  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / "undula_emulator.h5";
  void TearDown() override { std::filesystem::remove(file_); }
};

TEST_F(EmulatorFile, ComesBackAsItWasWritten) {
  const auto written = linear_emulator();
  save_emulator(written, file_.string());
  EXPECT_TRUE(holds_emulator(file_.string()));
  const auto read = load_emulator(file_.string());
  EXPECT_TRUE(read.driven_by_voltage);
  EXPECT_EQ(read.inputs[1].name, "voltage");
  EXPECT_EQ(read.inputs[2].high, 60);
  ASSERT_EQ(read.quantities.size(), 2u);
  EXPECT_EQ(read.quantities[1].unit, "mW");
  EXPECT_EQ(read.provenance, written.provenance);
  ASSERT_EQ(read.runs.size(), 2u);
  EXPECT_EQ(read.runs[1].point, written.runs[1].point);
  EXPECT_TRUE(read.runs[1].held_out);
  EXPECT_EQ(read.runs[0].standard_error_l_per_min, 0.02);
  const auto before = emulate(written, {120, 37, 51}), after = emulate(read, {120, 37, 51});
  for (int q : {0, 1}) {
    EXPECT_EQ(before.values[q].value, after.values[q].value);
    EXPECT_EQ(before.values[q].error, after.values[q].error);
  }
}

TEST_F(EmulatorFile, KeepsFurtherInputs) {
  save_emulator(with_modulus(), file_.string());
  const auto read = load_emulator(file_.string());
  ASSERT_EQ(read.inputs.size(), 4u);
  EXPECT_EQ(read.inputs[3].name, "membrane.young_dyn_per_cm2");
  EXPECT_EQ(read.inputs[3].unit, "dyn_per_cm2");
  EXPECT_EQ(read.inputs[3].stated, 1.5e7);
  EXPECT_EQ(read.force_N_per_V, 0.4);
  EXPECT_EQ(read.runs[1].point, with_modulus().runs[1].point);
  EXPECT_EQ(emulate(read, {120, 40, 40, 1.1e7}).values[0].value,
            emulate(with_modulus(), {120, 40, 40, 1.1e7}).values[0].value);
  ASSERT_EQ(read.responses.size(), 1u);
  EXPECT_EQ(read.responses[0].name, "outflow_l_per_min");
  const EmulatorPoint there{120, 40, 40, 1.1e7};
  const auto course = emulate(read, read.responses[0], there);
  EXPECT_EQ(course.values, emulate(with_modulus(), with_modulus().responses[0], there).values);
  EXPECT_NEAR(course.values(0, 1) - course.values(0, 3), 0, 1e-12);
  EXPECT_NEAR(course.values(0, 0) - 1, 0.5 * emulate(read, there).values[0].value, 1e-12);
  EXPECT_EQ(course.error, 0.3);
  auto broken = with_modulus();
  broken.responses[0].phases = 5;
  EXPECT_THROW(save_emulator(broken, file_.string()), InputError);
  broken = with_modulus();
  broken.runs[0].point.pop_back();
  EXPECT_THROW(save_emulator(broken, file_.string()), InputError);
}

TEST_F(EmulatorFile, RefusesOtherFilesAndDamage) {
  {
    auto other = Hdf5File::create(file_);
    other.write_attribute("/", "kind", "undula reduced model");
    other.commit();
  }
  EXPECT_FALSE(holds_emulator(file_.string()));
  EXPECT_THROW(load_emulator(file_.string()), InputError);
  save_emulator(linear_emulator(), file_.string());
  const auto size = std::filesystem::file_size(file_);
  for (const auto place : {size / 3, size / 2, size - 40}) {
    save_emulator(linear_emulator(), file_.string());
    std::fstream bytes(file_, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(place));
    const char there = static_cast<char>(bytes.get());
    bytes.seekp(static_cast<std::streamoff>(place));
    bytes.put(static_cast<char>(there ^ 0x10));
    bytes.close();
    EXPECT_THROW(load_emulator(file_.string()), InputError) << place;
  }
  auto broken = linear_emulator();
  broken.inputs[0].high = 130; // a width that the points do not have
  EXPECT_THROW(save_emulator(broken, file_.string()), InputError);
  broken = linear_emulator();
  broken.quantities.clear();
  EXPECT_THROW(save_emulator(broken, file_.string()), InputError);
}

} // namespace
} // namespace undula::rom
