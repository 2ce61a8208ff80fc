// Runs whose fluid domain follows the solids, as `undula solve` makes them: pictures with a mesh of their own
// at every step, and runs that go on from a checkpoint.
#include <gtest/gtest.h>

#include <stdexcept>

#include "fom/levels/finite_element_level.hpp"
#include "fom/levels/march.hpp"
#include "fom/output/run_directory.hpp"
#include "fom/scene/scene_file.hpp"
#include "io_folder.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

/// A leaf that stands in a channel of 16 x 8 mm, bent by the flow until it crosses elements. A map has to
/// resolve the leaf, which is thinner than the elements of a cut may be.
Scene bent_leaf(const std::string& coupling) {
  const std::string size = coupling == "mapped" ? "0.3" : "1.2";
  return parse_scene(R"toml(
name = "leaf"
[model]
space = "plane"
coupling = ")toml" + coupling +
                         R"toml("
[domain]
outline_mm = [[0.0, 0.0], [16.0, 0.0], [16.0, 8.0], [0.0, 8.0]]
sides = ["lower", "outlet", "upper", "inlet"]
size_mm = )toml" + size + R"toml(
[boundary.inlet]
kind = "velocity"
velocity_cm_per_s = ["0.6*y*(8 - y)*ramp(t, 0.02)", "0"]
[boundary.outlet]
kind = "opening"
[fluid]
density_g_per_cm3 = 1.0
viscosity_poise = 0.1
[body.leaf]
outline_mm = [[7.8, -1.0], [8.2, -1.0], [8.2, 0.0], [8.2, 4.0], [7.8, 4.0], [7.8, 0.0]]
line_mm = [[7.8, 0.0], [8.2, 0.0]]
size_mm = 0.5
law = "neo-hookean"
density_g_per_cm3 = 1.1
young_dyn_per_cm2 = 1e5
poisson = 0.4
held = "y <= 0"
[point.tip]
body = "leaf"
at_mm = [8.2, 4.0]
[time]
step_s = 0.002
end_s = 0.024
[output]
fields_every = 2
checkpoint_every = 5
[stabilisation]
reference_velocity_cm_per_s = 10.0
reference_time_s = 0.002
)toml",
                     "leaf", "/");
}

/// Area of triangles whose points have `stride` coordinates.
double area(const std::vector<double>& points, const std::vector<int>& cells, std::size_t stride) {
  double sum = 0;
  for (std::size_t cell = 0; cell < cells.size(); cell += 3) {
    const auto at = [&](std::size_t corner, std::size_t axis) {
      return points[stride * static_cast<std::size_t>(cells[cell + corner]) + axis];
    };
    sum += 0.5 * std::abs((at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) -
                          (at(2, 0) - at(0, 0)) * (at(1, 1) - at(0, 1)));
  }
  return sum;
}

/// Where it was placed, the part of the leaf in the channel, cm^2.
double area_in_channel(const SimplexMesh<2>& placed) {
  double sum = 0;
  for (std::size_t cell = 0; cell < placed.cells.size(); ++cell) {
    double centre = 0;
    for (const int point : placed.cells[cell]) centre += placed.points[point][1] / 3;
    if (centre > 0) sum += cell_measure(placed, static_cast<int>(cell));
  }
  return sum;
}

class MovingRunTest : public FolderTest, public testing::WithParamInterface<const char*> {
protected:
  /// Thrown to end a run without a word, as a kill would.
  struct Kill : std::runtime_error {
    Kill() : std::runtime_error("killed") {}
  };

  /// Runs to the end of the scene, or is killed after the step `killed`.
  State run(const Scene& scene, const std::string& name, ExistingRun existing, int killed = -1) {
    PhaseTimer timer;
    FiniteElementLevel level(scene, MPI_COMM_SELF, timer);
    State state = level.initial_state();
    RunDirectory output(folder / name, level.view(scene), scene, existing, 1, state);
    first_step = state.step;
    solid_area.clear();
    march(level, scene, state, timer, [&](const State& now, const Observation& seen) {
      output.record(now, seen);
      const auto& prepared = level.prepared();
      solid_area[now.step] = area_in_channel(prepared.disc.placed_solids[0]);
      sizes.insert(now.x[0].size());
      if (now.step == killed) throw Kill();
    });
    output.finish(state, timer);
    return state;
  }

  int first_step = 0;
  std::map<int, double> solid_area; ///< by step
  std::set<Eigen::Index> sizes;     ///< numbers of unknowns there were
};

TEST_P(MovingRunTest, GoesOnFromACheckpointBitForBit) {
  const Scene scene = bent_leaf(GetParam());
  const State whole = run(scene, "whole", ExistingRun::refuse);
  EXPECT_EQ(first_step, 0);
  EXPECT_EQ(whole.step, 12);
  EXPECT_GT(whole.d[0].lpNorm<Eigen::Infinity>(), 0.05);
  EXPECT_EQ(sizes.size() > 1, std::string(GetParam()) != "mapped");
  EXPECT_THROW(run(scene, "parts", ExistingRun::refuse, 7), Kill);
  const State parts = run(scene, "parts", ExistingRun::go_on);
  EXPECT_EQ(first_step, 5);
  EXPECT_EQ(parts.step, 12);
  for (const std::size_t level : {0, 1}) {
    EXPECT_EQ(parts.x[level], whole.x[level]);
    EXPECT_EQ(parts.d[level], whole.d[level]);
    EXPECT_EQ(parts.map[level], whole.map[level]);
  }
  EXPECT_EQ(parts.placement, whole.placement);
  EXPECT_EQ(parts.last_step, whole.last_step);
  for (const char* file : {"time_series.csv", "statistics.csv"})
    EXPECT_EQ(read_text_file(folder / "parts" / file), read_text_file(folder / "whole" / file)) << file;
  for (const char* file : {"fluid_2.h5", "fluid_6.h5", "fluid_12.h5"}) {
    const auto first = Hdf5File::open_read(folder / "parts" / file),
               second = Hdf5File::open_read(folder / "whole" / file);
    for (const char* values : {"points", "fields/velocity", "fields/pressure"})
      EXPECT_EQ(first.read<double>(values), second.read<double>(values)) << file << " " << values;
  }
}

TEST_P(MovingRunTest, DrawsTheFluidWhereItIs) {
  const std::string coupling = GetParam();
  run(bent_leaf(coupling), "run", ExistingRun::refuse);
  const std::string index = read_text_file(folder / "run" / "fluid.xdmf");
  std::vector<double> before;
  for (int step = 2; step <= 12; step += 2) {
    const std::string name = "fluid_" + std::to_string(step) + ".h5";
    EXPECT_NE(index.find(name + ":/points"), std::string::npos) << name;
    EXPECT_NE(index.find(name + ":/cells"), std::string::npos) << name;
    const auto file = Hdf5File::open_read(folder / "run" / name);
    const auto points = file.read<double>("points");
    EXPECT_EQ(file.extents("fields/pressure"), std::vector<std::size_t>{points.size() / 3});
    EXPECT_NE(points, before);
    // Fluid and leaf fill the channel. A map follows the skin up to the error of its elements.
    const double filled = area(points, file.read<int>("cells"), 3) + solid_area.at(step);
    EXPECT_NEAR(filled, 1.28, coupling == "mapped" ? 2e-4 : 1e-12) << "step " << step;
    before = points;
  }
}

TEST_P(MovingRunTest, SaysWhatMoved) {
  const std::string coupling = GetParam();
  run(bent_leaf(coupling), "run", ExistingRun::refuse);
  const auto table = read_time_series(folder / "run" / "time_series.csv");
  const auto column = [&](const std::string& name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    EXPECT_NE(found, table.columns.end()) << name;
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows(); ++row)
      values.push_back(table.value(row, static_cast<std::size_t>(found - table.columns.begin())));
    return values;
  };
  const auto volume = column("volume_ratio_min"), nodes = column("new_fluid_nodes"),
             error = column("placement_error_mm");
  if (coupling == "mapped") {
    EXPECT_LT(volume.back(), 0.999);
    EXPECT_GT(volume.back(), 0);
    EXPECT_EQ(*std::max_element(nodes.begin(), nodes.end()), 0);
  } else {
    EXPECT_EQ(volume.back(), 1);
    EXPECT_GT(*std::max_element(nodes.begin(), nodes.end()), 0);
  }
  EXPECT_GT(*std::max_element(error.begin(), error.end()), 0);
  if (coupling == "implicit") {
    EXPECT_LE(*std::max_element(error.begin(), error.end()), 1e-4);
  }
  EXPECT_EQ(column("step_parts").back(), 1);
}

INSTANTIATE_TEST_SUITE_P(Couplings, MovingRunTest, testing::Values("explicit", "implicit", "mapped"),
                         [](const auto& instance) { return std::string(instance.param); });

} // namespace
} // namespace undula::fom
