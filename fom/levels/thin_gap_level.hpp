// The thin-gap model behind the door.
#pragma once

#include "fom/levels/level.hpp"
#include "fom/thin_gap/thin_gap.hpp"

namespace undula::fom {

class ThinGapLevel final : public MarchingLevel {
public:
  explicit ThinGapLevel(ThinGapModel model) : model_(std::move(model)) {}

  /// Phases as prepare_thin_gap.
  ThinGapLevel(const Scene& scene, PhaseTimer& timer);

  std::string name() const override { return "thin gap"; }
  int unknowns() const override;
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;
  State initial_state() const override;
  std::unique_ptr<Marcher> start(const Scene& scene, const State& state, PhaseTimer& timer) override;
  Eigen::VectorXd displacements(const State& state) const override { return state.d[0]; }
  std::unique_ptr<StateMetric> metric() const override { return nullptr; }
  bool goes_from_head_to_head() const override { return true; }
  LevelView view(const Scene& scene) const override;

  const ThinGapModel& model() const { return model_; }

private:
  ThinGapModel model_;
};

} // namespace undula::fom
