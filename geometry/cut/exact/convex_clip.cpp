#include "geometry/cut/exact/convex_clip.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace undula::geometry {
namespace {

bool contains(const std::vector<int>& planes, int plane) {
  return std::find(planes.begin(), planes.end(), plane) != planes.end();
}

template <int dim>
std::vector<int> shared_planes(const ExactVertex<dim>& a, const ExactVertex<dim>& b) {
  std::vector<int> shared;
  for (const int plane : a.planes)
    if (contains(b.planes, plane)) shared.push_back(plane);
  return shared;
}

// Whether vertices a and b, which share the given hyperplanes, are the ends of an edge.
template <int dim>
bool adjacent(const Polytope<dim>& polytope, int a, int b, const std::vector<int>& shared) {
  for (int c = 0; c < static_cast<int>(polytope.vertices.size()); ++c) {
    if (c == a || c == b) continue;
    const auto& planes = polytope.vertices[c].planes;
    if (std::all_of(shared.begin(), shared.end(), [&](int plane) { return contains(planes, plane); }))
      return false;
  }
  return true;
}

// For each vertex: 1 inside the half-space, 0 on its boundary, -1 outside. A vertex known to lie on the
// hyperplane needs no arithmetic.
template <int dim>
std::vector<int> vertex_signs(const Polytope<dim>& polytope, HalfSpace half_space,
                              const HyperplaneTable<dim>& table) {
  const auto& plane = table[half_space.plane];
  std::vector<int> signs;
  for (const auto& vertex : polytope.vertices) {
    const int side = contains(vertex.planes, half_space.plane) ? 0 : static_cast<int>(plane.side(vertex.x));
    signs.push_back(half_space.positive ? side : -side);
  }
  return signs;
}

bool any_positive(const std::vector<int>& signs) { return *std::max_element(signs.begin(), signs.end()) > 0; }
bool any_negative(const std::vector<int>& signs) { return *std::min_element(signs.begin(), signs.end()) < 0; }

// Where the edge between two vertices on different sides of a hyperplane meets it.
template <int dim>
ExactPoint<dim> crossing(const ExactPoint<dim>& a, const ExactPoint<dim>& b, const Hyperplane<dim>& plane) {
  const Exact excess_a = plane.excess(a);
  const Exact excess_b = plane.excess(b);
  const Exact length = excess_a - excess_b;
  ExactPoint<dim> x;
  for (int i = 0; i < dim; ++i) x[i] = (excess_a * b[i] - excess_b * a[i]) / length;
  return x;
}

// Fan triangulation of a k-dimensional face given by its vertices, as lists of k + 1 vertices: cones from the
// first vertex over the facets which do not contain it.
template <int dim>
void fan(const Polytope<dim>& polytope, const std::vector<int>& face, int k, std::vector<int>& apexes,
         std::vector<std::vector<int>>& simplices) {
  if (static_cast<int>(face.size()) == k + 1) {
    simplices.push_back(apexes);
    simplices.back().insert(simplices.back().end(), face.begin(), face.end());
    return;
  }
  std::vector<int> planes;
  for (const int v : face)
    for (const int plane : polytope.vertices[v].planes)
      if (!contains(planes, plane)) planes.push_back(plane);
  std::vector<std::vector<int>> facets;
  for (const int plane : planes) {
    if (contains(polytope.vertices[face[0]].planes, plane)) continue;
    std::vector<int> facet;
    for (const int v : face)
      if (contains(polytope.vertices[v].planes, plane)) facet.push_back(v);
    if (static_cast<int>(facet.size()) >= k && std::find(facets.begin(), facets.end(), facet) == facets.end())
      facets.push_back(std::move(facet));
  }
  apexes.push_back(face[0]);
  for (const auto& facet : facets) fan(polytope, facet, k - 1, apexes, simplices);
  apexes.pop_back();
}

} // namespace

template <int dim>
Polytope<dim> cell_polytope(const HyperplaneTable<dim>& table, int mesh, int cell) {
  const auto sides = table.sides(mesh, cell);
  Polytope<dim> polytope{{}, {sides.begin(), sides.end()}};
  for (int v = 0; v <= dim; ++v) {
    ExactVertex<dim> vertex{exact_point<dim>(table.mesh(mesh).points[table.mesh(mesh).cells[cell][v]]), {}};
    for (int i = 0; i <= dim; ++i)
      if (i != v) vertex.planes.push_back(sides[i].plane);
    polytope.vertices.push_back(std::move(vertex));
  }
  return polytope;
}

template <int dim>
Halves<dim> split(const Polytope<dim>& polytope, HalfSpace half_space, const HyperplaneTable<dim>& table) {
  const int n = static_cast<int>(polytope.vertices.size());
  const auto sign = vertex_signs(polytope, half_space, table);
  Polytope<dim> inside{{}, polytope.sides};
  Polytope<dim> outside{{}, polytope.sides};
  inside.sides.push_back(half_space);
  outside.sides.push_back(half_space.complement());
  for (int v = 0; v < n; ++v) {
    ExactVertex<dim> vertex = polytope.vertices[v];
    if (sign[v] == 0 && !contains(vertex.planes, half_space.plane)) vertex.planes.push_back(half_space.plane);
    if (sign[v] <= 0) outside.vertices.push_back(vertex);
    if (sign[v] >= 0) inside.vertices.push_back(std::move(vertex));
  }
  if (!any_negative(sign)) return {std::move(inside), std::nullopt};
  if (!any_positive(sign)) return {std::nullopt, std::move(outside)};

  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (sign[a] * sign[b] >= 0) continue;
      auto shared = shared_planes(polytope.vertices[a], polytope.vertices[b]);
      if (!adjacent(polytope, a, b, shared)) continue;
      shared.push_back(half_space.plane);
      const auto x = crossing<dim>(polytope.vertices[a].x, polytope.vertices[b].x, table[half_space.plane]);
      inside.vertices.push_back({x, shared});
      outside.vertices.push_back({x, std::move(shared)});
    }
  }
  return {std::move(inside), std::move(outside)};
}

template <int dim>
std::vector<Polytope<dim>> subtract(const Polytope<dim>& polytope,
                                    const std::array<HalfSpace, dim + 1>& half_spaces,
                                    const HyperplaneTable<dim>& table,
                                    std::optional<Polytope<dim>>* removed) {
  // A polytope that touches the simplex along a facet lies outside one of its half-spaces, and must remember
  // which.
  for (const auto& half_space : half_spaces)
    if (const auto sign = vertex_signs(polytope, half_space, table);
        any_negative(sign) && !any_positive(sign))
      return {std::move(*split(polytope, half_space, table).outside)};

  std::vector<Polytope<dim>> pieces;
  Polytope<dim> rest = polytope;
  for (const auto& half_space : half_spaces) {
    Halves<dim> halves = split(rest, half_space, table);
    if (!halves.inside) return {polytope};
    if (halves.outside) pieces.push_back(std::move(*halves.outside));
    rest = std::move(*halves.inside);
  }
  if (removed) *removed = std::move(rest);
  return pieces;
}

template <int dim>
std::optional<Polytope<dim>> facet_in(const Polytope<dim>& polytope, int plane) {
  const auto count = [&](int p) {
    return std::count_if(polytope.vertices.begin(), polytope.vertices.end(),
                         [&](const auto& vertex) { return contains(vertex.planes, p); });
  };
  if (count(plane) < dim) return std::nullopt;
  Polytope<dim> facet;
  for (const auto& vertex : polytope.vertices)
    if (contains(vertex.planes, plane)) facet.vertices.push_back(vertex);
  for (const auto& side : polytope.sides)
    if (side.plane != plane && count(side.plane) >= dim) facet.sides.push_back(side);
  return facet;
}

template <int dim>
std::optional<Polytope<dim>> intersect(Polytope<dim> polytope, std::span<const HalfSpace> half_spaces,
                                       const HyperplaneTable<dim>& table) {
  for (const auto& half_space : half_spaces) {
    auto halves = split(polytope, half_space, table);
    if (!halves.inside) return std::nullopt;
    polytope = std::move(*halves.inside);
  }
  return polytope;
}

template <int dim, int k>
std::vector<std::array<Point<dim>, k + 1>> triangulate(const Polytope<dim>& polytope) {
  std::vector<Point<dim>> points;
  std::vector<int> all;
  for (const auto& vertex : polytope.vertices) {
    all.push_back(static_cast<int>(points.size()));
    auto& x = points.emplace_back();
    for (int i = 0; i < dim; ++i) x[i] = CGAL::to_double(vertex.x[i].exact());
  }
  std::vector<int> apexes;
  std::vector<std::vector<int>> index_lists;
  fan(polytope, all, k, apexes, index_lists);
  std::vector<std::array<Point<dim>, k + 1>> simplices(index_lists.size());
  for (std::size_t s = 0; s < simplices.size(); ++s)
    for (int i = 0; i <= k; ++i) simplices[s][i] = points[index_lists[s][i]];
  return simplices;
}

template <int dim>
Box<dim> bounding_box(const Polytope<dim>& polytope) {
  Box<dim> box{Point<dim>::Constant(std::numeric_limits<double>::infinity()),
               Point<dim>::Constant(-std::numeric_limits<double>::infinity())};
  for (const auto& vertex : polytope.vertices) {
    for (int i = 0; i < dim; ++i) {
      box.low[i] = std::min(box.low[i], vertex.x[i].approx().inf());
      box.high[i] = std::max(box.high[i], vertex.x[i].approx().sup());
    }
  }
  return box;
}

#define UNDULA_INSTANTIATE(dim)                                                                      \
  template Polytope<dim> cell_polytope<dim>(const HyperplaneTable<dim>&, int, int);                  \
  template Halves<dim> split<dim>(const Polytope<dim>&, HalfSpace, const HyperplaneTable<dim>&);     \
  template std::vector<Polytope<dim>> subtract<dim>(                                                 \
      const Polytope<dim>&, const std::array<HalfSpace, dim + 1>&, const HyperplaneTable<dim>&,      \
      std::optional<Polytope<dim>>*);                                                                \
  template std::optional<Polytope<dim>> facet_in<dim>(const Polytope<dim>&, int);                    \
  template std::optional<Polytope<dim>> intersect<dim>(Polytope<dim>, std::span<const HalfSpace>,    \
                                                       const HyperplaneTable<dim>&);                 \
  template Box<dim> bounding_box<dim>(const Polytope<dim>&);                                         \
  template std::vector<std::array<Point<dim>, dim>> triangulate<dim, dim - 1>(const Polytope<dim>&); \
  template std::vector<std::array<Point<dim>, dim + 1>> triangulate<dim, dim>(const Polytope<dim>&);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
