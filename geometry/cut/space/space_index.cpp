#include "geometry/cut/space/space_index.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "geometry/cut/cut_mesh.hpp"
#include "geometry/cut/space/orientation.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

std::vector<Box<3>> cell_boxes(const SimplexMesh<3>& mesh) {
  std::vector<Box<3>> boxes;
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) boxes.push_back(cell_box(mesh, c));
  return boxes;
}

// Which members (cells, facets) hold each item (edge, point): ranges and members.
template <class Members>
void list_holders(const Members& members, std::size_t items, std::vector<int>& first,
                  std::vector<int>& holders) {
  first.assign(items + 1, 0);
  for (const auto& member : members)
    for (const int item : member) ++first[item + 1];
  for (std::size_t i = 0; i < items; ++i) first[i + 1] += first[i];
  holders.resize(first.back());
  auto next = first;
  for (int m = 0; m < static_cast<int>(members.size()); ++m)
    for (const int item : members[m]) holders[next[item]++] = m;
}

} // namespace

SpaceIndex::SpaceIndex(const SimplexMesh<3>& mesh, const FacetTable<3>& facets)
    : mesh_(&mesh), facets_(&facets), cell_grid_(cell_boxes(mesh)) {
  const int cells = static_cast<int>(mesh.cells.size());
  struct Side {
    std::array<int, 2> points;
    int cell, local;
    bool operator<(const Side& other) const {
      return std::tie(points, cell, local) < std::tie(other.points, other.cell, other.local);
    }
  };
  constexpr auto locals = local_edges<3>();
  std::vector<Side> sides;
  sides.reserve(mesh.cells.size() * 6);
  for (int c = 0; c < cells; ++c) {
    const auto& v = mesh.cells[c];
    if (exact_orientation(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]) <= 0)
      throw NumericsError("a cell of a mesh to be cut is flat or inverted",
                          "cell " + std::to_string(c) + " of the background mesh",
                          "a mesh whose cells are all positively oriented");
    for (int e = 0; e < 6; ++e) {
      const auto [low, high] = std::minmax(v[locals[e][0]], v[locals[e][1]]);
      sides.push_back({{low, high}, c, e});
    }
  }
  std::sort(sides.begin(), sides.end());
  cell_edges.resize(cells);
  std::vector<std::array<int, 2>> ends;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (s == 0 || sides[s].points != sides[s - 1].points) {
      auto [low, high] = sides[s].points;
      const auto &p = mesh.points[low], &q = mesh.points[high];
      if (std::lexicographical_compare(q.data(), q.data() + 3, p.data(), p.data() + 3)) std::swap(low, high);
      edges.push_back({low, high});
      ends.push_back(sides[s].points);
    }
    cell_edges[sides[s].cell][sides[s].local] = static_cast<int>(edges.size()) - 1;
  }
  for (const auto& facet : facets.facets) {
    auto& of_facet = facet_edges.emplace_back();
    const auto& v = mesh.cells[facet.cells[0]];
    for (int i = 0; i < 3; ++i) {
      const int a = facet.points[i], b = facet.points[(i + 1) % 3];
      for (int e = 0; e < 6; ++e) {
        const int p = v[locals[e][0]], q = v[locals[e][1]];
        if ((p == a && q == b) || (p == b && q == a)) of_facet[i] = cell_edges[facet.cells[0]][e];
      }
    }
    const auto& x = mesh.points;
    positive_cell.push_back(exact_orientation(x[facet.points[0]], x[facet.points[1]], x[facet.points[2]],
                                              x[v[facet.local[0]]]) > 0
                                ? 0
                                : 1);
  }
  list_holders(cell_edges, edges.size(), first_cell, cells_of_edges);
  list_holders(facet_edges, edges.size(), first_facet, facets_of_edges);
  list_holders(ends, mesh.points.size(), first_edge, edges_of_points);
}

} // namespace undula::geometry
