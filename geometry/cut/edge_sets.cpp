#include <algorithm>
#include <utility>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/member_sets.hpp"

namespace undula::geometry {

template <int dim>
EdgeSets<dim> build_edge_sets(const CutMesh<dim>& cut) {
  constexpr auto edges = local_edges<dim>();
  constexpr int per_part = EdgeSets<dim>::per_part;
  const int n_parts = static_cast<int>(cut.parts.size());
  const auto points_of = [&](int part, int edge) {
    const auto& points = cut.mesh.cells[cut.parts[part].cell];
    const auto [low, high] = std::minmax(points[edges[edge][0]], points[edges[edge][1]]);
    return std::array{low, high};
  };
  MemberSets sets(static_cast<std::size_t>(n_parts) * per_part);
  for (const auto& connection : cut.connections) {
    const auto& on_facet = cut.facets.facets[connection.facet].points;
    const auto touches = [&](int point) {
      return std::find(on_facet.begin(), on_facet.end(), point) != on_facet.end();
    };
    for (int i = 0; i < per_part; ++i) {
      const auto edge = points_of(connection.part[0], i);
      if (!touches(edge[0]) || !touches(edge[1])) continue;
      for (int j = 0; j < per_part; ++j)
        if (points_of(connection.part[1], j) == edge)
          sets.unite(connection.part[0] * per_part + i, connection.part[1] * per_part + j);
    }
  }

  std::vector<std::pair<std::array<int, 2>, int>> unknowns; // (points, root)
  for (int part = 0; part < n_parts; ++part)
    for (int i = 0; i < per_part; ++i)
      if (const int e = part * per_part + i; sets.root(e) == e) unknowns.emplace_back(points_of(part, i), e);
  std::sort(unknowns.begin(), unknowns.end());

  EdgeSets<dim> result;
  result.part_edges.resize(n_parts);
  std::vector<int> unknown_of_root(static_cast<std::size_t>(n_parts) * per_part, -1);
  for (const auto& [points, root] : unknowns) {
    unknown_of_root[root] = static_cast<int>(result.edge_points.size());
    result.edge_points.push_back(points);
  }
  for (int part = 0; part < n_parts; ++part)
    for (int i = 0; i < per_part; ++i)
      result.part_edges[part][i] = unknown_of_root[sets.root(part * per_part + i)];
  return result;
}

template EdgeSets<2> build_edge_sets<2>(const CutMesh<2>&);
template EdgeSets<3> build_edge_sets<3>(const CutMesh<3>&);

} // namespace undula::geometry
