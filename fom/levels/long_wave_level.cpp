#include "fom/levels/long_wave_level.hpp"

#include "fom/levels/stepped_marcher.hpp"
#include "fom/long_wave/hose_flow.hpp"
#include "fom/long_wave/hose_picture.hpp"
#include "fom/machines/peristaltic_pump/hose_remarks.hpp"

namespace undula::fom {
namespace {

HoseModel timed_model(const Scene& scene, PhaseTimer& timer) {
  const auto scope = timer.measure("coefficients");
  return hose_model(scene);
}

} // namespace

LongWaveLevel::LongWaveLevel(const Scene& scene, PhaseTimer& timer) : model_(timed_model(scene, timer)) {}

std::vector<std::string> LongWaveLevel::remarks(const Scene& scene, std::span<const double>) const {
  return hose_remarks(scene);
}

State LongWaveLevel::initial_state() const { return hose_state_at_rest(model_); }

std::unique_ptr<Marcher> LongWaveLevel::start(const Scene& scene, const State&, PhaseTimer& timer) {
  return std::make_unique<SteppedMarcher<HoseStepper>>(model_, scene, timer);
}

LevelView LongWaveLevel::view(const Scene& scene) const {
  LevelView view;
  view.rows.hose = true;
  view.rows.hose_force = model_.ring.has_value();
  view.fluid = lumen_at_rest(model_);
  view.solids = walls_and_rollers(model_);
  view.membrane_box = box_around<2>(view.solids.points);
  const HoseModel& model = model_;
  const double frequency = scene.operating_point.frequency;
  view.moved_fluid = [&model, frequency](const State& state) { return lumen(model, frequency, state); };
  view.fluid_fields = [&model, scene](const State& state) { return lumen_fields(model, scene, state); };
  view.solid_fields = [&model, frequency](const State& state) {
    return wall_fields(model, frequency, state);
  };
  return view;
}

} // namespace undula::fom
