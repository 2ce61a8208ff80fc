// What one time step with a new cut, or a new map of the domain, costs beside its factorisation:
//   assembly_bench scene.toml [repetitions]
#include <petscsys.h>

#include <cstdio>
#include <cstdlib>

#include "fom/levels/prepared_scene.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_time.hpp"

int main(int argc, char** argv) {
  using namespace undula;
  if (argc < 2) {
    std::fprintf(stderr, "usage: assembly_bench scene.toml [repetitions]\n");
    return 2;
  }
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  {
    const int repetitions = argc > 2 ? std::atoi(argv[2]) : 5;
    const Scene scene = read_scene(argv[1]);
    PhaseTimer setup;
    const auto prepared = prepare_scene(scene, PETSC_COMM_SELF, setup);
    PhaseTimer build, step;
    State state = initial_state(prepared->disc);
    for (int k = 0; k < repetitions; ++k) {
      const auto operators = build_operators(prepared->disc, PETSC_COMM_SELF, build);
      TimeStepper<2> stepper(prepared->disc, operators, scene.time.scheme, time_step(scene), 1, step);
      stepper.advance(state);
    }
    std::printf("%d unknowns, %zu parts; seconds per step, mean of %d:\n", prepared->disc.unknowns(),
                prepared->disc.cut.parts.size(), repetitions);
    std::printf("  operators %.4f\n", build.records().at("assemble").seconds / repetitions);
    for (const auto& [phase, record] : step.records())
      std::printf("  system: %-8s %.4f\n", phase.c_str(), record.seconds / repetitions);
  }
  PetscFinalize();
}
