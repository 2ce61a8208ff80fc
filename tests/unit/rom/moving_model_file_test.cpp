// Files of models of a moving domain: what is written is read, what cannot be one is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/moving_domain/moving_model.hpp"

namespace undula::rom {
namespace {

MovingModel small_model() {
  MovingModel model;
  model.scene = "name = \"small\"\n";
  model.profile = "# a profile\n";
  model.basis = Eigen::MatrixXd::Random(7, 3);
  model.pressure_modes = 1;
  model.part_weights = {0, 2.5, 0, 0, 1};
  model.cell_weights = {};
  model.box.frequency_low_Hz = 100;
  model.box.frequency_high_Hz = 140;
  model.box.stroke_low_mm = 34;
  model.box.stroke_high_mm = 50;
  model.box.head_low_mmHg = 20;
  model.box.head_high_mmHg = 75;
  MovingRun run;
  run.frequency_Hz = 120;
  run.voltage_V = 40;
  run.head_mmHg = 50;
  run.held_out = true;
  run.flow_l_per_min = 1.9;
  run.rom_flow_l_per_min = 2.0;
  model.runs = {run, MovingRun{}};
  model.error_l_per_min = 0.1;
  model.provenance["scene"] = "text";
  return model;
}

class MovingModelFile : public testing::Test {
protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             ("undula-moving-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string file(const char* name) const { return (folder / name).string(); }
  std::filesystem::path folder;
};

TEST_F(MovingModelFile, ComesBackAsItWas) {
  const auto model = small_model();
  save_moving_model(model, file("model.h5"));
  EXPECT_TRUE(holds_moving_model(file("model.h5")));
  const auto back = load_moving_model(file("model.h5"));
  EXPECT_EQ(back.scene, model.scene);
  EXPECT_EQ(back.profile, model.profile);
  EXPECT_EQ(back.basis, model.basis);
  EXPECT_EQ(back.pressure_modes, 1);
  EXPECT_EQ(back.part_weights, model.part_weights);
  EXPECT_EQ(back.cell_weights, model.cell_weights);
  EXPECT_EQ(back.box.stroke_high_mm, 50);
  EXPECT_EQ(back.box.head_low_mmHg, 20);
  ASSERT_EQ(back.runs.size(), 2U);
  EXPECT_TRUE(back.runs[0].held_out);
  EXPECT_FALSE(back.runs[1].held_out);
  EXPECT_EQ(back.runs[0].flow_l_per_min, 1.9);
  EXPECT_EQ(back.runs[0].rom_flow_l_per_min, 2.0);
  EXPECT_EQ(back.error_l_per_min, 0.1);
  EXPECT_EQ(back.provenance.at("scene"), "text");
}

TEST_F(MovingModelFile, AMissingFileHoldsNone) { EXPECT_FALSE(holds_moving_model(file("none.h5"))); }

TEST_F(MovingModelFile, RefusesWhatCannotBeAModel) {
  const auto refused = [&](auto&& spoil) {
    auto model = small_model();
    spoil(model);
    save_moving_model(model, file("bad.h5"));
    EXPECT_THROW(load_moving_model(file("bad.h5")), InputError);
  };
  refused([](MovingModel& model) { model.basis(2, 1) = std::numeric_limits<double>::quiet_NaN(); });
  refused([](MovingModel& model) { model.pressure_modes = 4; });
  refused([](MovingModel& model) { model.box.head_low_mmHg = 80; });
  refused([](MovingModel& model) { model.box.head_high_mmHg = std::numeric_limits<double>::infinity(); });
  refused([](MovingModel& model) { model.error_l_per_min = std::numeric_limits<double>::quiet_NaN(); });
  refused([](MovingModel& model) { model.part_weights[1] = std::numeric_limits<double>::infinity(); });
}

TEST_F(MovingModelFile, WritesNoWeightThatIsNone) {
  for (const double weight : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    auto model = small_model();
    model.part_weights[0] = weight;
    EXPECT_THROW(save_moving_model(model, file("bad.h5")), InputError);
  }
}

TEST_F(MovingModelFile, RefusesAFileOfAnotherKind) {
  auto other = Hdf5File::create(file("other.h5"));
  other.write_attribute("/", "kind", "undula emulator");
  other.commit();
  EXPECT_FALSE(holds_moving_model(file("other.h5")));
  EXPECT_THROW(load_moving_model(file("other.h5")), InputError);
}

} // namespace
} // namespace undula::rom
