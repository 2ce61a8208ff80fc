// Example 3: a flag that moves in the flow behind a cylinder: case FSI2 of Turek & Hron (2006) on a coarse
// mesh, from its scene file. A push lifts the flag; what the flow and its own stiffness do then is computed.
//   example_3_flag data/scenes/turek_hron_fsi2.toml
#include <petscsys.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "fom/levels/march.hpp"
#include "fom/scene/scene_file.hpp"

namespace {

using namespace undula;
using namespace undula::fom;

void swing(const char* file) {
  // 1. The scene, coarser and shorter than it is shipped: any key can be set.
  const std::vector<std::string> settings = {"model.coupling=mapped",
                                             "constants.T=0.1",
                                             "domain.size_mm=50",
                                             "domain.growth=0.2",
                                             "boundary.cylinder.size_mm=10",
                                             "body.flag.size_mm=20",
                                             "body.flag.fluid_size_mm=10",
                                             "time.step_s=0.01",
                                             "time.end_s=0.8",
                                             "output.statistics_from_s=0"};
  const Scene scene = read_scene(file, settings);

  // 2. Meshes, the cut of the flag out of the channel, matrices.
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  std::printf("%d unknowns\n", level->unknowns());

  // 3. Which of the observed columns holds the height of the tip.
  const RowLayout rows = level->view(scene).rows;
  const auto columns = observation_columns(rows);
  const auto tip = std::find(columns.begin(), columns.end(), "A_displacement_y_mm") - columns.begin();

  // 4. March from rest, and look at the tip after every step.
  double highest = 0, last = 0;
  State state = level->initial_state();
  march(*level, scene, state, timer, [&](const State& now, const Observation& seen) {
    last = observation_row(seen, rows)[static_cast<std::size_t>(tip)];
    highest = std::max(highest, last);
    if (now.step % 10 == 0) std::printf("t = %.1f s   tip at %7.3f mm\n", now.time, last);
  });

  // 5. The push has lifted the tip, and it has come back.
  std::printf("highest %.1f mm, at the end %.1f mm\n", highest, last);
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SCENE.toml\n", argv[0]);
    return 2;
  }
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  int exit_code = 0;
  try {
    swing(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    exit_code = 1;
  }
  PetscFinalize();
  return exit_code;
}
