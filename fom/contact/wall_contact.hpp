// Contact of displaced solids with the walls of the fluid's domain: a film that resists being closed.
//
// A node of the skin at distance g from the nearest wall is pushed off by the pressure
//   p(g) = stiffness * (film / g - 1)   for g < film, 0 beyond,
// a barrier that no finite load closes; below a small part of the film, its tangent. The pressure acts along
// the normal of the wall on the area that belongs to the node. It is linearised about where the solids are
// placed: implicit in the displacement of the step, with the set of nodes in contact known beforehand.
#pragma once

#include "fom/assembly/sparse.hpp"
#include "fom/problem/stepping.hpp"
#include "fom/space/boundary_walls.hpp"
#include "fom/space/discretisation.hpp"

namespace undula::fom {

/// What of a problem takes part in contact, prepared once.
template <int dim>
struct WallContact {
  ContactSettings settings;
  bool axisymmetric = false;
  struct SkinNode {
    int unknown = -1; ///< of component 0 among the solids' unknowns
    Point<dim> at_rest;
  };
  /// Free nodes. Those that are within the film of a wall at rest are left out: there a solid is attached.
  std::vector<SkinNode> skin;
  /// An edge of the skin with its vertices, the solid on their left, and its quadratic nodes; in space a
  /// triangle, that goes round counter-clockwise as seen from outside of the solid.
  struct SkinEdge {
    std::array<int, dim> unknowns; ///< of the vertices, component 0 among the solids' unknowns
    std::array<Point<dim>, dim> at_rest;
    /// Vertices, then the mid-points of (0,1), (1,2), (2,0): index into `skin`, -1: takes no part.
    std::array<int, dim*(dim + 1) / 2> nodes;
  };
  std::vector<SkinEdge> edges;
  std::vector<BoundaryWall<dim>> walls;
};

template <int dim>
WallContact<dim> prepare_contact(const Discretisation<dim>& disc, const ContactSettings& settings);

/// Pressure of the film, dyn/cm^2, and its derivative by the gap.
struct FilmPressure {
  double pressure = 0, slope = 0;
};
FilmPressure film_pressure(const ContactSettings& settings, double gap);

/// Distance of a place to the nearest wall, negative outside of the domain, and the direction that opens it.
template <int dim>
struct Gap {
  double distance = 0; ///< cm
  Point<dim> direction;
};
template <int dim>
Gap<dim> gap_to_walls(const WallContact<dim>& contact, const Point<dim>& x);

/// Smallest gap of the skin's free nodes when the solids are displaced by `placement` (solids' unknowns).
/// Infinite without walls or free skin.
template <int dim>
double smallest_gap(const WallContact<dim>& contact, const Eigen::VectorXd& placement);

/// The film's force on the solids, linearised about `placement`: force = load - stiffness * displacement.
/// Unknowns of all, dyn and dyn/cm; 0 at a gap beyond the film.
struct ContactForce {
  SparseMatrix stiffness;
  Eigen::VectorXd load;
  int nodes = 0; ///< in contact
};
template <int dim>
ContactForce contact_force(const WallContact<dim>& contact, const Discretisation<dim>& disc,
                           const Eigen::VectorXd& placement);

/// Largest difference of the gaps of two placements (both solids' unknowns), relative to the smaller one,
/// over the nodes that are in the film in either.
template <int dim>
double film_difference(const WallContact<dim>& contact, const Eigen::VectorXd& first,
                       const Eigen::VectorXd& second);

/// Draws back, towards where they are `now`, those nodes of an expected `placement` (both solids' unknowns)
/// that would lose more than half of what is left of their film.
template <int dim>
void keep_off_walls(const WallContact<dim>& contact, const Eigen::VectorXd& now, Eigen::VectorXd& placement);

/// How well a force that was linearised about `linearised` holds for the displacement it led to, and where to
/// linearise next: Newton's method for the barrier, kept from falling by more than 70 % of a gap at once.
struct ContactBalance {
  double error = 0;           ///< |exact - linearised| force over the exact, summed over the nodes
  double smallest_gap = 0;    ///< cm, infinite without nodes
  Eigen::VectorXd linearised; ///< solids' unknowns
};
template <int dim>
ContactBalance contact_balance(const WallContact<dim>& contact, const Eigen::VectorXd& linearised,
                               const Eigen::VectorXd& displacement);

} // namespace undula::fom
