// Forces on the skins of solids: loads, and contact with rigid bodies, other skins and themselves.
//
// Contact presses by p = stiffness * (film - gap)+ per area at rest, integrated over the skin: a potential,
// so what is pressed gives its energy back. The gap of a place of a skin is its distance to the rigid body,
// or to the nearest place of the other skin that faces it (a quadratic curve: closest-point projection with
// its derivatives, Wriggers, Computational Contact Mechanics, 2nd ed. 2006, ch. 4). Between two skins both
// are integrated over, with half the pressure each, in pieces that end where nodes of the other lie opposite:
// so a uniform pressure passes exactly between meshes that do not match. Friction is Coulomb's, with slip v
// along the skin: t = -friction * p * v / sqrt(v^2 + creep^2). It has no memory: what sticks creeps.
#pragma once

#include <span>

#include "fom/assembly/sparse.hpp"
#include "fom/contact/rigid_gap.hpp"
#include "fom/contact/skin.hpp"

namespace undula::fom {

/// Of one contact pair at the end of a step; forces in dyn, powers in erg/s (per cm of depth in plane space).
template <int dim>
struct PairReport {
  Point<dim> force = Point<dim>::Zero(); ///< on the skin of the first body
  double load = 0;                       ///< pressure times area, however it is directed
  double pressure = 0;                   ///< dyn/cm^2, the largest, per area where the skin is
  double length = 0;                     ///< cm, of the first skin in the film, in the plane or meridian
  double penetration = 0;                ///< cm, deepest in the film
  double energy = 0;                     ///< erg, stored in the film
  double power = 0;                      ///< taken from the solids, friction included
  double friction_power = 0;             ///< dissipated
};

/// What of a problem has to do with its skins.
template <int dim>
struct SkinForces {
  bool axisymmetric = false;
  double step = 0;                              ///< s, scale of differences in time
  std::vector<std::vector<SkinEdge<dim>>> skin; ///< by solid
  std::vector<double>
      reach; ///< cm, by contact pair: how far inside of a skin a place still counts as in contact
};

/// `step`: of time, s.
template <int dim>
SkinForces<dim> prepare_skin_forces(const Discretisation<dim>& disc, double step);

/// Whether the problem has loads or contact pairs.
template <int dim>
bool has_skin_forces(const FsiProblem<dim>& problem) {
  return !problem.loads.empty() || !problem.pairs.empty();
}

/// Forces on all unknowns, dyn, linearised: force = load - stiffness * d, d = about + change.
template <int dim>
struct SkinResponse {
  Eigen::VectorXd loads, contact;       ///< exact, where they were asked for
  SparseMatrix stiffness;               ///< dyn/cm; empty without `derive`
  std::vector<PairReport<dim>> reports; ///< by contact pair
};

/// Displacements and velocities in natural order, at time t. `rate`: of the scheme, v = rate * d + ..., 1/s.
/// Where `before` is not null, places that were in contact at those displacements, at `time_before`, count as
/// in contact, and pull if need be: a first guess of a step that does not let go of what it holds.
template <int dim>
struct SkinMotion {
  const Eigen::VectorXd& d;
  const Eigen::VectorXd& v;
  double time = 0;
  double rate = 0;
  const Eigen::VectorXd* before = nullptr;
  double time_before = 0;
};

/// The same on every rank; not collective.
template <int dim>
SkinResponse<dim> skin_response(const SkinForces<dim>& forces, const Discretisation<dim>& disc,
                                const SkinMotion<dim>& motion, bool derive);

} // namespace undula::fom
