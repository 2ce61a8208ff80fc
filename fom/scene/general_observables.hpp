// What a scene asks to be observed: flow through openings, forces, and points that are followed.
#pragma once

#include <span>

#include "fom/scene/scene.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// One value per step in surface units; its name ends in the unit.
struct GeneralColumn {
  std::string name;
  double cgs_per_unit = 1;
};

/// A force summed over solids and boundaries.
struct GeneralForce {
  std::vector<int> solids;
  std::vector<std::string> boundaries;
};

/// A point of a solid, by the nodes of its cell and their weights.
struct SolidPoint {
  std::vector<int> unknowns; ///< of component 0, counted from the first unknown of all solids
  std::vector<double> weights;
};

/// Columns in the order of `columns`: openings, forces, contact pairs, points of solids, points of the fluid.
struct GeneralObservables {
  std::vector<GeneralColumn> columns;
  std::vector<std::string> openings;
  std::vector<GeneralForce> forces;
  std::vector<int> components; ///< of a force that are reported
  int pairs = 0;               ///< of contact
  std::vector<SolidPoint> solid_points;
  std::vector<Point<2>> fluid_points; ///< cm
};

/// Plans what the scene states. Throws InputError for a point outside of its body, or outside of the fluid at
/// rest.
GeneralObservables plan_general_observables(const Discretisation<2>& disc, const Scene& scene);

/// One value per column, cgs, of the step that ended in `state` and left this `residual`
/// (TimeStepper::residual) and this contact (TimeStepper::contact_reports). Points of the fluid that a solid
/// covers give nan. Collective.
std::vector<double> observe_general(const GeneralObservables& plan, const Discretisation<2>& disc,
                                    const Operators<2>& operators, const Eigen::VectorXd& residual,
                                    std::span<const PairReport<2>> pairs, const State& state);

} // namespace undula::fom
