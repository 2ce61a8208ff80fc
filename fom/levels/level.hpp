// The one door to every model. Whoever asks states a scene or a model file and gets the physics that it
// states:
//
//   Level          a curve of heads: any model
//   MarchingLevel  a level that marches states in time: thin gaps, hoses, finite elements of any coupling
//   Marcher        one march at one operating point
//
// march.hpp holds the loop over steps, periodic_run.hpp what is made of it.
#pragma once

#include <mpi.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fom/levels/curve_point.hpp"
#include "fom/output/level_view.hpp"
#include "fom/output/observables.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// A model of the pump, prepared once for any number of operating points.
class Level {
public:
  virtual ~Level() = default;

  /// What computes: "thin gap", "full order, explicit", "reduced model".
  virtual std::string name() const = 0;

  /// Number of unknowns of one time step.
  virtual int unknowns() const = 0;

  /// Flows at `heads_mmHg`, in their order, at the frequency and stroke of `scene`, whose operating point may
  /// differ from the one the level was prepared with; `on_point` after every point. What fails at a head is
  /// told in its point. Collective; complete on every rank.
  virtual std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                        const std::function<void()>& on_point = {}) = 0;

  /// What a user has to know before believing that curve, a sentence each.
  virtual std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const = 0;
};

/// One march of a level at one operating point.
class Marcher {
public:
  virtual ~Marcher() = default;

  /// One time step of `state`, and what is seen at its end. Throws NumericsError on every rank, leaving
  /// `state` at the last good step. Collective.
  virtual Observation advance(State& state) = 0;
};

/// How states of one level are measured and combined: the mass norm, and the roots of the mass's diagonal
/// (natural order), in whose coordinates it is about the Euclidean norm.
struct StateMetric {
  std::function<double(const Eigen::VectorXd&)> norm;
  Eigen::VectorXd root_weights;
};

/// A level that marches in time.
class MarchingLevel : public Level {
public:
  /// Rest.
  virtual State initial_state() const = 0;

  /// A march from `state` at the operating point of `scene`. Level and timer have to outlive it; one march of
  /// a level at a time. Phases "assemble", "factor", "solve", "observe", and those of its coupling.
  virtual std::unique_ptr<Marcher> start(const Scene& scene, const State& state, PhaseTimer& timer) = 0;

  /// Displacements of the solids, cm: as long at every step.
  virtual Eigen::VectorXd displacements(const State& state) const = 0;

  /// Nothing where sums of states are no states, since each has a geometry of its own.
  virtual std::unique_ptr<StateMetric> metric() const = 0;

  /// Whether the state at one head is a good start for the next: if not, every head starts from rest.
  virtual bool goes_from_head_to_head() const = 0;

  /// What is written and drawn of it, while its geometry is that of rest; for one rank. The level has to
  /// outlive the view.
  virtual LevelView view(const Scene& scene) const = 0;

  /// marched_curve (marched_curve.hpp).
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;
};

/// Prepares the level that the scene states: thin gaps, a hose, or finite elements. Phases "mesh", "cut",
/// "assemble" or "coefficients". Collective over `comm`. Thin gaps and hoses are small: every rank prepares
/// and marches the same, so that all of them hold the state.
std::unique_ptr<MarchingLevel> prepare_level(const Scene& scene, MPI_Comm comm, PhaseTimer& timer);

} // namespace undula::fom
