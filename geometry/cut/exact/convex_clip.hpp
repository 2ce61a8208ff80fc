// Convex polytopes in exact arithmetic: splitting by hyperplanes of the input meshes, facets, triangulation.
//
// A polytope is the list of its vertices, each with the hyperplanes known to pass through it (the double
// description of Motzkin et al. 1953). That is enough in any dimension: two vertices are joined by an edge
// when no third one lies on all the hyperplanes they share. A polytope may be of lower dimension than space
// (a facet).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/cut/exact/hyperplane_table.hpp"

namespace undula::geometry {

template <int dim>
struct ExactVertex {
  ExactPoint<dim> x;
  std::vector<int> planes; ///< hyperplanes known to contain x
};

template <int dim>
struct Polytope {
  std::vector<ExactVertex<dim>> vertices;
  std::vector<HalfSpace> sides; ///< half-spaces known to contain the polytope (some may be redundant)
};

/// The two halves of a polytope; a half without measure (in the dimension of the polytope) is absent.
/// A polytope that lies in the hyperplane counts as inside.
template <int dim>
struct Halves {
  std::optional<Polytope<dim>> inside, outside;
};

/// A cell as a polytope.
template <int dim>
Polytope<dim> cell_polytope(const HyperplaneTable<dim>& table, int mesh, int cell);

/// Splits by the boundary of a half-space.
template <int dim>
Halves<dim> split(const Polytope<dim>& polytope, HalfSpace half_space, const HyperplaneTable<dim>& table);

/// The convex polytope minus the intersection of half-spaces, as convex pieces with disjoint interiors.
/// `removed`, if given, receives the intersection. A polytope not met in its interior comes back in one piece
/// that remembers the hyperplane which separates it.
template <int dim>
std::vector<Polytope<dim>> subtract(const Polytope<dim>& polytope,
                                    const std::array<HalfSpace, dim + 1>& half_spaces,
                                    const HyperplaneTable<dim>& table,
                                    std::optional<Polytope<dim>>* removed = nullptr);

/// The facet of a full-dimensional polytope in a hyperplane, if it has one there. Its `sides` are the
/// half-spaces of the other facets.
template <int dim>
std::optional<Polytope<dim>> facet_in(const Polytope<dim>& polytope, int plane);

/// Intersection with half-spaces; absent if without measure (in the dimension of the polytope).
template <int dim>
std::optional<Polytope<dim>> intersect(Polytope<dim> polytope, std::span<const HalfSpace> half_spaces,
                                       const HyperplaneTable<dim>& table);

/// Simplices of dimension k (that of the polytope) which fill it. Coordinates are rounded from their exact
/// values, so that a point has the same coordinates in every polytope and whatever was computed before.
template <int dim, int k>
std::vector<std::array<Point<dim>, k + 1>> triangulate(const Polytope<dim>& polytope);

/// Box that contains the polytope, rounded outwards.
template <int dim>
Box<dim> bounding_box(const Polytope<dim>& polytope);

} // namespace undula::geometry
