#include "fom/levels/thin_gap_level.hpp"

#include "fom/levels/prepared_scene.hpp"
#include "fom/levels/stepped_marcher.hpp"

namespace undula::fom {

ThinGapLevel::ThinGapLevel(const Scene& scene, PhaseTimer& timer) : model_(prepare_thin_gap(scene, timer)) {}

int ThinGapLevel::unknowns() const { return fom::unknowns(model_); }

std::vector<std::string> ThinGapLevel::remarks(const Scene&, std::span<const double>) const { return {}; }

State ThinGapLevel::initial_state() const { return fom::initial_state(model_); }

std::unique_ptr<Marcher> ThinGapLevel::start(const Scene& scene, const State&, PhaseTimer& timer) {
  return std::make_unique<SteppedMarcher<ThinGapStepper>>(model_, scene, timer);
}

LevelView ThinGapLevel::view(const Scene& scene) const {
  LevelView view;
  view.rows.voltage = scene.operating_point.drive == Drive::voltage;
  view.probes = membrane_probes(model_, membrane_probe_count);
  view.fluid = fluid_picture(model_);
  view.solids = solid_picture(model_);
  for (const auto& edge : boundary_edges(view.fluid))
    view.outlines.push_back({view.fluid.points[edge[0]], view.fluid.points[edge[1]]});
  view.membrane_box = box_around<2>(view.solids.points);
  const ThinGapModel& model = model_;
  view.fluid_fields = [&model](const State& state) { return fluid_fields(model, state); };
  view.solid_fields = [&model](const State& state) { return solid_fields(model, state); };
  return view;
}

} // namespace undula::fom
