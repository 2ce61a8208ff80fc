// The hyperplanes of all facets of the meshes that take part in a cut, in exact arithmetic.
#pragma once

#include <CGAL/Gmpq.h>
#include <CGAL/Lazy_exact_nt.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/mesh/box_grid.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Interval arithmetic first, rationals where the interval does not decide.
using Exact = CGAL::Lazy_exact_nt<CGAL::Gmpq>;

template <int dim>
using ExactPoint = std::array<Exact, dim>;

template <int dim>
ExactPoint<dim> exact_point(const Point<dim>& x) {
  ExactPoint<dim> exact;
  for (int i = 0; i < dim; ++i) exact[i] = Exact(x[i]);
  return exact;
}

/// normal . x = offset.
template <int dim>
struct Hyperplane {
  ExactPoint<dim> normal;
  Exact offset;

  /// normal . x - offset: positive on the side of the normal.
  Exact excess(const ExactPoint<dim>& x) const {
    Exact value = -offset;
    for (int i = 0; i < dim; ++i) value += normal[i] * x[i];
    return value;
  }

  /// Sign of the excess. Most signs are decided here, on intervals, without recording operations for later.
  CGAL::Sign side(const ExactPoint<dim>& x) const {
    {
      const CGAL::Protect_FPU_rounding<true> upward;
      CGAL::Interval_nt<false> value = -offset.approx();
      for (int i = 0; i < dim; ++i) value += normal[i].approx() * x[i].approx();
      if (const auto sign = CGAL::sign(value); CGAL::is_certain(sign)) return CGAL::get_certain(sign);
    }
    return CGAL::sign(excess(x));
  }
};

/// The closed side of a hyperplane that its normal points to (`positive`), or the other.
struct HalfSpace {
  int plane = -1;
  bool positive = true;
  HalfSpace complement() const { return {plane, !positive}; }
};

/// Hyperplanes numbered mesh by mesh, facet by facet; coefficients are made on first use. The normal points
/// into the first cell of the facet.
template <int dim>
class HyperplaneTable {
public:
  /// The views must outlive the table.
  HyperplaneTable(std::vector<const SimplexMesh<dim>*> meshes, std::vector<const FacetTable<dim>*> facets);

  int plane(int mesh, int facet) const { return first_[mesh] + facet; }

  /// Half-spaces whose intersection is the cell; half-space i belongs to the facet opposite vertex i.
  std::array<HalfSpace, dim + 1> sides(int mesh, int cell) const;

  struct Origin {
    int mesh, facet;
  };
  Origin origin(int plane) const;

  /// Throws NumericsError if a cell on the facet is flat, or if its two cells lie on one side (a folded
  /// mesh).
  const Hyperplane<dim>& operator[](int plane) const;

  const SimplexMesh<dim>& mesh(int m) const { return *meshes_[m]; }
  const FacetTable<dim>& facets(int m) const { return *facets_[m]; }
  int mesh_count() const { return static_cast<int>(meshes_.size()); }

private:
  Hyperplane<dim> make(int mesh, const Facet<dim>& facet) const;

  std::vector<const SimplexMesh<dim>*> meshes_;
  std::vector<const FacetTable<dim>*> facets_;
  std::vector<int> first_;
  mutable std::vector<std::optional<Hyperplane<dim>>> planes_;
};

} // namespace undula::geometry
