// Long-wave flow along a squeezed hose, behind the door.
#pragma once

#include "fom/levels/level.hpp"
#include "fom/long_wave/hose_model.hpp"

namespace undula::fom {

class LongWaveLevel final : public MarchingLevel {
public:
  /// Phase "coefficients".
  LongWaveLevel(const Scene& scene, PhaseTimer& timer);

  std::string name() const override { return "long wave"; }
  int unknowns() const override { return 1; }
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;
  State initial_state() const override;
  std::unique_ptr<Marcher> start(const Scene& scene, const State& state, PhaseTimer& timer) override;
  Eigen::VectorXd displacements(const State& state) const override { return state.d[0]; }
  std::unique_ptr<StateMetric> metric() const override { return nullptr; }
  bool goes_from_head_to_head() const override { return true; }
  LevelView view(const Scene& scene) const override;

private:
  HoseModel model_;
};

} // namespace undula::fom
