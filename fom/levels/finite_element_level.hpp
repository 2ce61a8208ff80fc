// Finite elements on a cut mesh, with any coupling, behind the door.
#pragma once

#include "fom/levels/level.hpp"
#include "fom/levels/prepared_scene.hpp"

namespace undula::fom {

class FiniteElementLevel final : public MarchingLevel {
public:
  /// Phases as prepare_scene. Collective over `comm`.
  FiniteElementLevel(const Scene& scene, MPI_Comm comm, PhaseTimer& timer);

  std::string name() const override;
  int unknowns() const override { return unknowns_; }
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;
  State initial_state() const override { return rest_; }

  /// Where the fluid's domain moves, discretisation and operators follow the state of the march.
  std::unique_ptr<Marcher> start(const Scene& scene, const State& state, PhaseTimer& timer) override;

  Eigen::VectorXd displacements(const State& state) const override;
  std::unique_ptr<StateMetric> metric() const override;
  bool goes_from_head_to_head() const override { return false; }
  LevelView view(const Scene& scene) const override;

  const PreparedScene& prepared() const { return *prepared_; }

  /// From now on every march seeks its unknowns in `space`. Phase "assemble". Collective.
  void reduce(std::shared_ptr<const ReducedSpace> space, PhaseTimer& timer);

private:
  std::unique_ptr<PreparedScene> prepared_;
  Coupling coupling_;
  int unknowns_ = 0; ///< at rest
  State rest_;
};

} // namespace undula::fom
