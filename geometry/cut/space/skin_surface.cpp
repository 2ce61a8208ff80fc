#include "geometry/cut/space/skin_surface.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

// The vertices of a positive cell opposite to vertex i, counter-clockwise seen from it.
constexpr int seen_from[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

std::array<int, 3> turned(const SimplexMesh<3>& mesh, int cell, int local) {
  std::array<int, 3> points;
  for (int i = 0; i < 3; ++i) points[i] = mesh.cells[cell][seen_from[local][i]];
  std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
  return points;
}

void list_edges(SkinSurface& skin) {
  struct Side {
    std::array<int, 2> points;
    int triangle, local;
    bool operator<(const Side& other) const {
      return std::tie(points, triangle, local) < std::tie(other.points, other.triangle, other.local);
    }
  };
  std::vector<Side> sides;
  for (int t = 0; t < static_cast<int>(skin.triangles.size()); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] =
          std::minmax(skin.triangles[t].points[i], skin.triangles[t].points[(i + 1) % 3]);
      sides.push_back({{low, high}, t, i});
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto& side = sides[s];
    if (s == 0 || sides[s - 1].points != side.points)
      skin.edges.push_back({side.points, {side.triangle, -1}});
    else if (skin.edges.back().triangles[1] < 0)
      skin.edges.back().triangles[1] = side.triangle;
    else
      skin.edges.back().pinched = true;
    skin.triangles[side.triangle].edges[side.local] = static_cast<int>(skin.edges.size()) - 1;
  }
  skin.first_edge.assign(skin.points.size() + 1, 0);
  for (const auto& edge : skin.edges)
    for (const int p : edge.points) ++skin.first_edge[p + 1];
  for (std::size_t p = 0; p < skin.points.size(); ++p) skin.first_edge[p + 1] += skin.first_edge[p];
  skin.edges_of_points.resize(skin.first_edge.back());
  auto next = skin.first_edge;
  for (int e = 0; e < static_cast<int>(skin.edges.size()); ++e)
    for (const int p : skin.edges[e].points) skin.edges_of_points[next[p]++] = e;
}

} // namespace

SkinSurface build_skin_surface(std::span<const SimplexMesh<3>> solids,
                               std::span<const FacetTable<3>> facets) {
  SkinSurface skin;
  for (int s = 0; s < static_cast<int>(solids.size()); ++s) {
    std::vector<int> skin_point(solids[s].points.size(), -1);
    for (const auto& facet : facets[s].facets) {
      const auto points = turned(solids[s], facet.cells[0], facet.local[0]);
      if (facet.cells[1] >= 0) {
        if (points == turned(solids[s], facet.cells[1], facet.local[1]))
          throw NumericsError(
              "a mesh to be cut is folded",
              "cell " + std::to_string(facet.cells[0]) + " of the solid mesh " + std::to_string(s),
              "a mesh whose cells are all positively oriented");
        continue;
      }
      SkinTriangle triangle{s, facet.cells[0], {}, {}};
      for (int i = 0; i < 3; ++i) {
        int& p = skin_point[points[i]];
        if (p < 0) {
          p = static_cast<int>(skin.points.size());
          skin.points.push_back({s, points[i]});
        }
        triangle.points[i] = p;
      }
      skin.triangles.push_back(triangle);
    }
  }
  list_edges(skin);
  return skin;
}

std::vector<Point<3>> place_surface(const SkinSurface& skin, std::span<const SimplexMesh<3>> solids) {
  std::vector<Point<3>> placed;
  placed.reserve(skin.points.size());
  for (const auto& [solid, point] : skin.points) placed.push_back(solids[solid].points[point]);
  return placed;
}

} // namespace undula::geometry
