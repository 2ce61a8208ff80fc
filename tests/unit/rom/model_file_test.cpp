#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/fixed_domain/field_bases.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

namespace fs = std::filesystem;

Model sample_model() {
  Model model;
  model.operators = synthetic_operators({7, 3, 2}, 1.0);
  model.operators.supremizer_modes = 3;
  model.steps_per_period = 96;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  model.references = {{120, 0.53, 40, 3.25, 1e-4, true, 3.26, 0.01, 0.02, 512.5},
                      {80, 0.1, 0, 0.1 / 3, 0, false, 0.03, 0.1, 0.2, 99}};
  model.error_safety = 1.0 / 3;
  model.error_floor_l_per_min = 0.01;
  model.provenance = {{"scene", "name = \"pump\"\n[time]\n"}, {"commit", "0123abc"}, {"note", ""}};
  return model;
}

void expect_same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)), 0);
}

class ModelFileTest : public testing::Test {
protected:
  void SetUp() override {
    file_ =
        fs::temp_directory_path() / ("undula_model_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name() + ".h5");
  }
  void TearDown() override { fs::remove(file_); }
  fs::path file_;
};

TEST_F(ModelFileTest, RoundTripIsBitForBit) {
  auto model = sample_model();
  model.operators.linear(0, 1) = -0.0;
  model.operators.mass(1, 0) = std::numeric_limits<double>::denorm_min();
  save_model(model, file_);
  const auto read = load_model(file_);
  const auto &a = model.operators, &b = read.operators;
  EXPECT_EQ(b.velocity_modes, 7);
  EXPECT_EQ(b.supremizer_modes, 3);
  EXPECT_EQ(b.pressure_modes, 3);
  EXPECT_EQ(b.displacement_modes, 2);
  expect_same_bits(a.mass, b.mass);
  expect_same_bits(a.linear, b.linear);
  expect_same_bits(a.stiffness, b.stiffness);
  ASSERT_EQ(b.convection.size(), 7u);
  for (std::size_t k = 0; k < 7; ++k) expect_same_bits(a.convection[k], b.convection[k]);
  expect_same_bits(a.imposed_mass, b.imposed_mass);
  expect_same_bits(a.imposed_linear, b.imposed_linear);
  expect_same_bits(a.imposed_stiffness, b.imposed_stiffness);
  expect_same_bits(a.head, b.head);
  expect_same_bits(a.outflow, b.outflow);
  expect_same_bits(a.inflow, b.inflow);
  expect_same_bits(a.envelope, b.envelope);
  expect_same_bits(a.envelope_imposed, b.envelope_imposed);
  expect_same_bits(a.envelope_radius, b.envelope_radius);
  EXPECT_EQ(read.steps_per_period, 96);
  EXPECT_EQ(read.box.stroke_low_mm, 0.1);
  EXPECT_EQ(read.box.head_high_mmHg, 70);
  ASSERT_EQ(read.references.size(), 2u);
  EXPECT_TRUE(read.references[0].held_out);
  EXPECT_FALSE(read.references[1].held_out);
  EXPECT_EQ(read.references[1].flow_l_per_min, 0.1 / 3);
  EXPECT_EQ(read.references[0].fom_seconds, 512.5);
  EXPECT_EQ(read.error_safety, 1.0 / 3);
  EXPECT_EQ(read.error_floor_l_per_min, 0.01);
  EXPECT_EQ(read.provenance, model.provenance);
}

TEST_F(ModelFileTest, EveryDatasetOfNumbersNamesItsUnit) {
  save_model(sample_model(), file_);
  const auto file = Hdf5File::open_read(file_);
  for (const std::string group : {"operators", "training_box", "error_estimate"})
    for (const auto& name : file.children(group))
      EXPECT_NE(file.unit(group + "/" + name), "") << group << "/" << name;
  EXPECT_EQ(file.unit("references/flow"), "l/min");
}

TEST_F(ModelFileTest, RefusesTruncatedAndForeignFiles) {
  EXPECT_THROW(load_model(file_), InputError);
  save_model(sample_model(), file_);
  const auto size = fs::file_size(file_);
  for (const auto length : {std::uintmax_t{0}, std::uintmax_t{50}, size / 3, size - 1}) {
    fs::resize_file(file_, length);
    EXPECT_THROW(load_model(file_), InputError) << length;
    save_model(sample_model(), file_);
  }
  {
    auto other = Hdf5File::create(file_);
    other.write("velocity", std::vector<double>{1, 2});
    other.commit();
  }
  try {
    load_model(file_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not a reduced model"), std::string::npos) << error.what();
  }
}

TEST_F(ModelFileTest, RefusesNumbersThatAreNotFiniteAndWrongSizes) {
  auto model = sample_model();
  model.operators.linear(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(save_model(model, file_), InputError);
  EXPECT_FALSE(fs::exists(file_));
  model = sample_model();
  model.operators.outflow.conservativeResize(5);
  fs::remove(file_);
  EXPECT_THROW(save_model(model, file_), InputError);
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(ModelFileTest, RefusesABoxAndAnErrorEstimateThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Model&)>> wrongs = {
      [](Model& m) { std::swap(m.box.head_low_mmHg, m.box.head_high_mmHg); },
      [](Model& m) { m.box.frequency_low_Hz = 0; },
      [&](Model& m) { m.box.stroke_high_mm = nan; },
      [](Model& m) { m.error_safety = -1; },
      [&](Model& m) { m.error_safety = nan; },
      [](Model& m) { m.error_floor_l_per_min = -0.1; },
      [&](Model& m) { m.references[0].flow_l_per_min = nan; },
      [](Model& m) { m.steps_per_period = 3; },
      [](Model& m) { m.steps_per_period = 2000000000; }};
  for (std::size_t k = 0; k < wrongs.size(); ++k) {
    auto model = sample_model();
    wrongs[k](model);
    EXPECT_THROW(save_model(model, file_), InputError) << k;
  }
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(ModelFileTest, AFileWithoutItsSealIsRefused) {
  save_model(sample_model(), file_);
  EXPECT_TRUE(load_model(file_).sealed);
  std::ifstream in(file_, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(in), {}};
  in.close();
  std::ofstream(file_, std::ios::binary) << "X" + content.substr(1);
  EXPECT_THROW(load_model(file_), InputError);
  std::ofstream(file_, std::ios::binary) << content.substr(512);
  EXPECT_THROW(load_model(file_), InputError);
}

TEST_F(ModelFileTest, FieldsStandBesideTheModelAndFitIt) {
  const Model model = sample_model();
  FieldBases fields;
  fields.fluid = {Eigen::MatrixXd::Random(5, 2), (Eigen::MatrixXi(2, 3) << 0, 1, 2, 2, 3, 4).finished()};
  fields.solids = {Eigen::MatrixXd::Random(3, 2), (Eigen::MatrixXi(1, 3) << 0, 1, 2).finished()};
  fields.velocity = Eigen::MatrixXd::Random(10, 7);
  fields.pressure = Eigen::MatrixXd::Random(5, 3);
  fields.displacement = Eigen::MatrixXd::Random(6, 2);
  fields.holder = Eigen::VectorXd::Random(6);
  save_model(model, file_.string(), fields);

  // 1. The model is the same as without; the modes are kept by point, component, mode.
  expect_same_bits(load_model(file_.string()).operators.mass, model.operators.mass);
  const auto file = Hdf5File::open_sealed(file_);
  EXPECT_EQ(file.read_attribute<int>("fields", "format_version"), field_bases_version);
  const auto velocity = file.read<double>("fields/fluid/velocity", {5, 2, 7});
  EXPECT_EQ(velocity[(3 * 2 + 1) * 7 + 4], fields.velocity(3 * 2 + 1, 4));
  EXPECT_EQ(file.read<double>("fields/fluid/points", {5, 2})[7], fields.fluid.points(3, 1));
  EXPECT_EQ(file.read<int>("fields/fluid/cells", {2, 3})[4], 3);
  EXPECT_EQ(file.read<double>("fields/solids/holder", {3, 2})[3], fields.holder[3]);
  EXPECT_EQ(file.read<double>("fields/solids/displacement", {3, 2, 2}).size(), 12U);

  // 2. What does not fit is not written.
  const auto refused = [&](const std::function<void(FieldBases&)>& spoil) {
    FieldBases other = fields;
    spoil(other);
    EXPECT_THROW(save_model(model, file_.string(), other), InputError);
  };
  refused([](FieldBases& f) { f.velocity.conservativeResize(10, 6); });
  refused([](FieldBases& f) { f.pressure.conservativeResize(4, 3); });
  refused([](FieldBases& f) { f.fluid.cells(0, 0) = 5; });
  refused([](FieldBases& f) { f.holder[0] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_NO_THROW(load_model(file_.string()));
}

TEST(RestrictOperators, EqualsProjectionOnFewerModes) {
  // Restriction must equal V^T (operator) V with V the unit vectors of the modes kept, supremizers included.
  auto full = synthetic_operators({9, 3, 3}, 1.0);
  full.supremizer_modes = 3;
  const auto part = restrict_operators(full, 4, 2, 2);
  EXPECT_EQ(part.velocity_modes, 6);
  EXPECT_EQ(part.supremizer_modes, 2);
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(15, 10);
  const int kept[] = {0, 1, 2, 3, 6, 7, 9, 10, 12, 13};
  for (int i = 0; i < 10; ++i) v(kept[i], i) = 1;
  EXPECT_EQ(part.mass, v.transpose() * full.mass * v);
  EXPECT_EQ(part.linear, v.transpose() * full.linear * v);
  EXPECT_EQ(part.stiffness, full.stiffness.topLeftCorner(2, 2));
  EXPECT_EQ(part.imposed_linear, v.transpose() * full.imposed_linear);
  EXPECT_EQ(part.head, v.transpose() * full.head);
  const Eigen::MatrixXd vu = v.topLeftCorner(9, 6);
  EXPECT_EQ(part.outflow, vu.transpose() * full.outflow);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(6, -1, 2);
  Eigen::MatrixXd c_part = Eigen::MatrixXd::Zero(6, 6), c_full = Eigen::MatrixXd::Zero(9, 9);
  for (int k = 0; k < 6; ++k) c_part += b[k] * part.convection[static_cast<std::size_t>(k)];
  const Eigen::VectorXd b_full = vu * b;
  for (int k = 0; k < 9; ++k) c_full += b_full[k] * full.convection[static_cast<std::size_t>(k)];
  EXPECT_LT((c_part - vu.transpose() * c_full * vu).norm(), 1e-15);
  EXPECT_THROW(restrict_operators(full, 7, 2, 2), InputError);
  EXPECT_THROW(restrict_operators(full, 4, 4, 2), InputError);
}

} // namespace
} // namespace undula::rom
