// Example 4: train a reduced model and ask it. A tiny campaign: one frequency and stroke, three heads, a very
// coarse mesh.
//   example_4_train_and_query data/scenes/wave_pump_fixed_training.toml
#include <slepcsys.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "fom/scene/scene_file.hpp"
#include "rom/curve/hq_curve.hpp"
#include "training/campaign/campaign.hpp"
#include "training/reduction/build_model.hpp"

namespace {

using namespace undula;

void train_and_ask(const char* file) {
  // 1. The scene and the box that the model is to know: 0 to 20 mmHg at 120 Hz and 0.3 mm.
  const std::vector<std::string> settings = {
      "mesh.gap_elements=2",        "mesh.channel_size_mm=1.5",      "mesh.growth=1",
      "time.steps_per_period=24",   "training.frequency_low_Hz=120", "training.frequency_high_Hz=120",
      "training.stroke_low_mm=0.3", "training.stroke_high_mm=0.3",   "training.head_high_mmHg=20",
      "training.training_points=0", "training.held_out_points=1",    "training.periodic_tolerance=1e-3",
      "training.velocity_modes=0",  "training.pressure_modes=0",     "training.displacement_modes=0"};
  const fom::Scene scene = fom::read_scene(file, settings);

  // 2. Where the full order is run: at both ends of the box, and at one point inside that only judges.
  const training::SamplingPlan plan = training::plan_samples(scene.training);
  std::vector<fom::OperatingPoint> points = plan.training;
  points.insert(points.end(), plan.held_out.begin(), plan.held_out.end());

  // 3. Those runs, each marched until it repeats itself. Killed and started again, a campaign goes on.
  const std::filesystem::path folder = "example_4_runs";
  std::filesystem::remove_all(folder);
  const auto store = training::CampaignStore::of_scene(folder, scene);
  training::run_campaign(scene, points, store, MPI_COMM_SELF,
                         [](const training::RunRecord& run, std::size_t done, std::size_t total) {
                           std::printf("run %zu of %zu: %s, %zu periods\n", done, total,
                                       run.state == training::RunState::periodic ? "periodic" : "left out",
                                       run.cycles.periods.size());
                         });

  // 4. Bases, projection, judgement on the held-out run, and the file.
  PhaseTimer timer;
  const training::TrainedModel trained = training::build_model(scene, plan, store, timer);
  rom::save_model(trained.model, "example_4_model.h5");
  for (const auto& run : trained.model.references)
    std::printf("%-8s  full order %8.4f l/min   reduced %8.4f l/min\n",
                run.held_out ? "held out" : "training", run.flow_l_per_min, run.rom_flow_l_per_min);

  // 5. Ask the file, as example 1 does.
  const std::vector<double> heads_mmHg = {0, 5, 10, 15, 20};
  for (const auto& point : rom::hq_curve(rom::load_model("example_4_model.h5"), 120, 0.3, heads_mmHg))
    std::printf("%4.0f mmHg  %8.4f +- %.4f l/min\n", point.head_mmHg, point.flow_l_per_min,
                point.error_l_per_min);
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SCENE.toml\n", argv[0]);
    return 2;
  }
  SlepcInitialize(&argc, &argv, nullptr, nullptr);
  int exit_code = 0;
  try {
    train_and_ask(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    exit_code = 1;
  }
  SlepcFinalize();
  return exit_code;
}
