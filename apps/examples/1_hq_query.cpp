// Example 1: the head-flow curve of a reduced model. Needs rom/ only: no MPI, no PETSc, no mesh.
//   example_1_hq_query data/models/wave_pump_fixed.h5
#include <cstdio>
#include <exception>
#include <vector>

#include "rom/rom.hpp"

int main(int argc, char** argv) try {
  using namespace undula;
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s MODEL.h5\n", argv[0]);
    return 2;
  }

  // 1. The model: reduced operators, the box it was trained in, and how far it can be trusted.
  const rom::Model model = rom::load_model(argv[1]);

  // 2. The question: one frequency and stroke, several heads.
  const double frequency_Hz = 120, stroke_mm = 0.53;
  const std::vector<double> heads_mmHg = {0, 20, 40, 60};
  for (const auto& warning : rom::outside_training_box(model.box, frequency_Hz, stroke_mm, heads_mmHg))
    std::fprintf(stderr, "warning: %s\n", warning.c_str());

  // 3. The periodic state at every head.
  const auto points = rom::hq_curve(model, frequency_Hz, stroke_mm, heads_mmHg);

  // 4. The answer, with the error that the model states of itself.
  std::printf("head (mmHg)  flow (l/min)  error (l/min)\n");
  for (const auto& point : points)
    std::printf("%11.1f  %12.4f  %13.4f%s\n", point.head_mmHg, point.flow_l_per_min, point.error_l_per_min,
                point.converged ? "" : "  not periodic");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
