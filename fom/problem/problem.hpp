// A fluid-structure problem on a fixed cut, stated as plain data: what the discretisation needs and no more.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fom/actuator/actuator.hpp"
#include "fom/fom.hpp"
#include "fom/problem/conditions.hpp"
#include "fom/problem/fields.hpp"
#include "fom/problem/materials.hpp"
#include "fom/problem/skin_conditions.hpp"
#include "fom/problem/stabilisation_weights.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// Condition on a named part of the background's boundary.
template <int dim>
struct BoundaryCondition {
  enum class Kind {
    velocity, ///< u = velocity(x, t), imposed strongly
    symmetry, ///< the normal component vanishes on a side along a coordinate axis: axis of symmetry
    opening   ///< normal stress by `pressure`, see OpeningCondition
  };
  Kind kind = Kind::velocity;
  VectorField<dim> velocity; ///< empty: zero
  TimeFunction pressure;     ///< dyn/cm^2, empty: zero
  OpeningCondition opening = OpeningCondition::total_pressure;
  /// Flow enters or leaves an opening along its normal: the tangential components vanish. The opening has to
  /// be aligned with a coordinate plane.
  bool tangential_zero = true;
};

/// A solid with its own mesh. Displacement is imposed at the nodes of the region where `imposed` holds.
template <int dim>
struct SolidBody {
  std::string name;
  SimplexMesh<dim> mesh;
  SolidProperties properties;
  SolidModel model = SolidModel::linear;
  std::function<bool(const Point<dim>&)> imposed; ///< empty: nowhere
  VectorField<dim> imposed_displacement;          ///< cm, empty: zero
  VectorField<dim> body_force;                    ///< dyn/cm^3, empty: zero
  VectorField<dim> initial_velocity;              ///< cm/s at rest positions, t = 0; empty: zero
};

/// A rigid holder that an actuator drives: the imposed nodes of all solids move with it along the last axis,
/// and not at all along the others.
struct DrivenHolder {
  ActuatorSettings actuator;
  TimeFunction voltage; ///< V
};

/// `background` may have no cells (a solid in vacuo) and `solids` may be empty (a rigid channel).
template <int dim>
struct FsiProblem {
  Space space = Space::plane;
  FlowModel flow = FlowModel::navier_stokes;
  FluidProperties fluid;
  SimplexMesh<dim> background;
  std::vector<SolidBody<dim>> solids;
  std::vector<SkinLoad<dim>> loads;
  std::vector<RigidBody<dim>> rigid;
  std::vector<ContactPair> pairs;
  std::optional<DrivenHolder> holder;                     ///< empty: the solids' imposed displacements hold
  std::map<std::string, BoundaryCondition<dim>> boundary; ///< by name; every boundary name needs one
  VectorField<dim> body_force;                            ///< dyn/cm^3 on the fluid, empty: zero
  /// Polynomial degree of the fluid's velocity, 1 or 2. The pressure is linear: with degree 2 the pair is
  /// stable by itself (Taylor & Hood 1973), with degree 1 by its penalties.
  int velocity_order = 1;
  StabilisationWeights stabilisation;
  double slip_length = 0;    ///< cm, of Navier's slip law on the skins of the solids; 0: no slip
  bool pin_pressure = false; ///< enclosed flow: fix the constant of the pressure at one node
};

/// Weight of the volume element: 2 pi r in axisymmetric space, 1 in plane space (per cm of depth) and in 3D.
struct Measure {
  bool axisymmetric = false;
  double operator()(double r) const;
};

Measure measure_of(Space space);

} // namespace undula::fom
