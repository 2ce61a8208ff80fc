// What a run reports at every step, in cgs.
#pragma once

#include <limits>
#include <optional>

#include "fom/coupling/motion_report.hpp"
#include "fom/output/blood_stress.hpp"
#include "fom/output/holder_observation.hpp"
#include "fom/output/hose_observation.hpp"
#include "fom/scene/general_observables.hpp"
#include "fom/space/boundary_walls.hpp"
#include "geometry/mesh/segments.hpp"

namespace undula::fom {

/// Axial displacement along the membrane's mid-plane as a linear functional of the displacement array.
struct MembraneProbes {
  std::vector<double> radius; ///< cm, ascending
  SparseMatrix axial;         ///< radius.size() x solid unknowns, the last of the displacement array

  /// Axial displacement at the probes, cm, from a whole displacement array (State::d).
  Eigen::VectorXd axial_displacement(const Eigen::VectorXd& d) const { return axial * d.tail(axial.cols()); }
};

/// `count` probes, evenly spaced in r over solid 0, half-way between its lower and upper skin.
template <int dim>
MembraneProbes membrane_probes(const Discretisation<dim>& disc, int count);

struct Observation {
  int step = 0;
  double time = 0;            ///< s
  double outflow = 0;         ///< out of the outlet, cm^3/s
  double inflow = 0;          ///< into the inlet, cm^3/s
  double hydraulic_power = 0; ///< head times outflow, erg/s
  EnergyTerms energy;
  double speed_max = 0;             ///< cm/s
  double wall_shear_max = 0;        ///< dyn/cm^2, over the housing and stator
  double wall_shear_mean = 0;       ///< dyn/cm^2, area mean
  std::vector<double> wall_shear;   ///< dyn/cm^2, by wall of the plan; 0 where a solid covers it
  std::optional<BloodStress> blood; ///< of pumps
  double clearance_min = 0; ///< cm, displaced skin to walls; negative where the skin has passed a wall
  /// Elements of the background across the narrowest film, 0 beyond a wall, where the solids of a pump move
  /// through them; NaN elsewhere.
  double film_elements = std::numeric_limits<double>::quiet_NaN();
  double tip_displacement = 0; ///< cm, axial, innermost probe
  HolderObservation holder;
  std::optional<HoseObservation> hose; ///< of peristaltic pumps
  MotionReport motion;                 ///< of couplings that move the domain
  int solves = 0;                      ///< linear solves of the step
  double convection_error = 0;         ///< TimeStepper::convection_error, of the last part of the step
  std::vector<double> general;         ///< by GeneralObservables::columns, cgs
};

/// A film with fewer elements across it is not resolved: docs/moving.md.
inline bool film_is_resolved(double elements) { return elements >= 4; }

/// Precomputed geometry of the observables.
template <int dim>
struct ObservationPlan {
  MembraneProbes probes;
  std::vector<int> skin_unknowns; ///< component 0 of the skin's nodes, counted from the solids' first unknown
  std::vector<Point<dim>> skin_positions; ///< at rest, cm
  std::vector<BoundaryWall<dim>> walls;
  std::vector<Segment<dim>> outline;   ///< all boundary simplices
  std::vector<int> wall_of_facet;      ///< by facet of the background: its place in `walls`, or -1
  std::optional<BloodDamageLaw> blood; ///< nothing: not observed
  GeneralObservables general;          ///< empty but for scenes that state their problem
};

/// No probes for `probe_count` 0.
template <int dim>
ObservationPlan<dim> plan_observation(const Discretisation<dim>& disc, int probe_count);

/// Collective.
template <int dim>
Observation observe(const Discretisation<dim>& disc, const Operators<dim>& operators,
                    const TimeStepper<dim>& stepper, const ObservationPlan<dim>& plan, const State& state);

} // namespace undula::fom
