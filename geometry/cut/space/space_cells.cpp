#include "geometry/cut/space/space_cells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/cut/member_sets.hpp"

namespace undula::geometry {
namespace {

/// What the simplices of a part may differ from its volume, in parts of the cell.
constexpr double fill_tolerance = 2e-13;

} // namespace

/// A side of the polygon that a triangle leaves in a cell: along a facet, or a piece of an edge of the skin.
struct SpaceCells::Side {
  int triangle;
  SkinNode from, to;
  bool operator<(const Side& other) const {
    return std::tie(triangle, from.kind, from.index, to.kind, to.index) <
           std::tie(other.triangle, other.from.kind, other.from.index, other.to.kind, other.to.index);
  }
};

SpaceCells::SpaceCells(const SpaceIndex& background, const SkinSurface& skin, std::vector<Point<3>> placed)
    : background_(background),
      skin_(skin),
      placed_(std::move(placed)),
      trace_(trace_surface(background, skin, placed_, touching_triangles(skin, placed_))),
      patch_index_(background.facets().facets.size(), -1) {
  const auto& facets = background.facets().facets;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const auto& cells = facets[f].cells;
    if (!trace_.meets(f) || (trace_.uncertain[cells[0]] && (cells[1] < 0 || trace_.uncertain[cells[1]])))
      continue;
    auto found = find_patches(background_, skin_, placed_, trace_, f);
    // The boundary's rules need patches without holes.
    const bool holes = cells[1] < 0 && found && std::any_of(found->begin(), found->end(), [](const auto& p) {
                         return !p.holes.empty();
                       });
    if (!found || holes) {
      for (const int cell : cells)
        if (cell >= 0) trace_.uncertain[cell] = 1;
      continue;
    }
    patch_index_[f] = static_cast<int>(patches_.size());
    patches_.push_back(std::move(*found));
  }
  // Skin that lies inside of a cell whole.
  for (int cell = 0; cell < static_cast<int>(trace_.uncertain.size()); ++cell)
    if (trace_.first_point[cell + 1] > trace_.first_point[cell] && !is_cut(cell)) trace_.uncertain[cell] = 1;
  spread_uncertainty(background_, trace_);
}

bool SpaceCells::is_cut(int cell) const {
  const auto& facets = background_.facets().cell_facets[cell];
  return std::any_of(facets.begin(), facets.end(), [&](int f) { return trace_.meets(f); });
}

const Point<3>& SpaceCells::position(const SkinNode& node) const {
  switch (node.kind) {
    case SkinNode::Kind::edge_crossing:
      return trace_.edge_crossings[node.index].x;
    case SkinNode::Kind::facet_crossing:
      return trace_.facet_crossings[node.index].x;
    default:
      return placed_[node.index];
  }
}

Point<3> SpaceCells::normal(int triangle) const {
  const auto& points = skin_.triangles[triangle].points;
  const auto &a = placed_[points[0]], &b = placed_[points[1]], &c = placed_[points[2]];
  return (b - a).cross(c - a).normalized();
}

bool SpaceCells::link_polygon(std::span<Side> sides, ConvexPolygon& polygon) const {
  polygon.count = 0;
  if (sides.size() < 3 || static_cast<int>(sides.size()) > ConvexPolygon::most) return false;
  SkinNode at = sides[0].to;
  polygon.x[polygon.count++] = position(at);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    auto next = std::find_if(sides.begin() + static_cast<std::ptrdiff_t>(i), sides.end(),
                             [&](const Side& s) { return s.from == at || s.to == at; });
    if (next == sides.end()) return false;
    at = next->from == at ? next->to : next->from;
    polygon.x[polygon.count++] = position(at);
    std::swap(*next, sides[i]);
  }
  return at == sides[0].from;
}

bool SpaceCells::find_bodies(int cell, const std::array<bool, 4>& fluid, FluidBodies& bodies) {
  const auto& mesh = background_.mesh();
  const auto& cell_facets = background_.facets().cell_facets[cell];
  bodies.polygons.clear();
  bodies.patches.clear();
  bodies.volumes.clear();

  // The sides of the polygons.
  std::vector<Side> sides;
  struct End {
    int skin_edge;
    SkinNode node;
  };
  std::vector<End> ends; // of what the cell holds of each edge of the skin
  for (const int f : cell_facets) {
    for (int s = trace_.first_segment[f]; s < trace_.first_segment[f + 1]; ++s)
      sides.push_back({trace_.segments[s].triangle, trace_.segments[s].ends[0], trace_.segments[s].ends[1]});
    for (int c = trace_.first_on_facet[f]; c < trace_.first_on_facet[f + 1]; ++c)
      ends.push_back({trace_.facet_crossings[c].skin_edge, {SkinNode::Kind::facet_crossing, c}});
  }
  for (int i = trace_.first_point[cell]; i < trace_.first_point[cell + 1]; ++i) {
    const int point = trace_.points_of_cells[i];
    for (int k = skin_.first_edge[point]; k < skin_.first_edge[point + 1]; ++k)
      ends.push_back({skin_.edges_of_points[k], {SkinNode::Kind::point, point}});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return std::tie(a.skin_edge, a.node.kind, a.node.index) <
           std::tie(b.skin_edge, b.node.kind, b.node.index);
  });
  std::vector<int> skin_edges;
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    if (i + 1 == ends.size() || ends[i].skin_edge != ends[i + 1].skin_edge) return false;
    if (i + 2 < ends.size() && ends[i + 2].skin_edge == ends[i].skin_edge) return false;
    skin_edges.push_back(ends[i].skin_edge);
    for (const int triangle : skin_.edges[ends[i].skin_edge].triangles)
      sides.push_back({triangle, ends[i].node, ends[i + 1].node});
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].triangle == sides[i].triangle) ++j;
    auto& polygon = bodies.polygons.emplace_back();
    polygon.triangle = sides[i].triangle;
    if (!link_polygon(std::span(sides).subspan(i, j - i), polygon.shape)) return false;
    i = j;
  }

  // Patches of fluid on the facets.
  for (int k = 0; k < 4; ++k) {
    if (const auto* of_facet = patches(cell_facets[k]))
      for (int p = 0; p < static_cast<int>(of_facet->size()); ++p) bodies.patches.push_back({k, p, -1});
    else if (trace_.meets(cell_facets[k]))
      return false;
    else if (fluid[(k + 1) % 4])
      bodies.patches.push_back({k, -1, -1});
  }

  // What meets along a side has the same fluid before it.
  const int polygons = static_cast<int>(bodies.polygons.size());
  MemberSets sets(polygons + bodies.patches.size());
  const auto polygon_of = [&](int triangle) {
    const auto found = std::lower_bound(bodies.polygons.begin(), bodies.polygons.end(), triangle,
                                        [](const auto& p, int t) { return p.triangle < t; });
    return static_cast<int>(found - bodies.polygons.begin());
  };
  for (const int e : skin_edges)
    sets.unite(polygon_of(skin_.edges[e].triangles[0]), polygon_of(skin_.edges[e].triangles[1]));
  struct Shore {
    int edge, index, patch;
  };
  std::vector<Shore> shores;
  for (int p = 0; p < static_cast<int>(bodies.patches.size()); ++p) {
    const auto& patch = bodies.patches[p];
    const int f = cell_facets[patch.local];
    if (patch.index < 0) {
      for (const int e : background_.facet_edges[f]) shores.push_back({e, 0, p});
      continue;
    }
    const auto& shape = (*patches(f))[patch.index];
    for (const int s : shape.segments) sets.unite(polygon_of(trace_.segments[s].triangle), polygons + p);
    for (const auto& stretch : shape.stretches) shores.push_back({stretch.edge, stretch.index, p});
  }
  std::sort(shores.begin(), shores.end(), [](const Shore& a, const Shore& b) {
    return std::tie(a.edge, a.index, a.patch) < std::tie(b.edge, b.index, b.patch);
  });
  if (shores.size() % 2 == 1) return false;
  for (std::size_t i = 0; i < shores.size(); i += 2) {
    if (shores[i].edge != shores[i + 1].edge || shores[i].index != shores[i + 1].index) return false;
    sets.unite(polygons + shores[i].patch, polygons + shores[i + 1].patch);
  }

  // Parts by their first member. One without a patch is a surface closed in the cell.
  std::vector<int> part_of_root(polygons + bodies.patches.size(), -1);
  int count = 0;
  for (int p = 0; p < static_cast<int>(bodies.patches.size()); ++p) {
    int& part = part_of_root[sets.root(polygons + p)];
    if (part < 0) part = count++;
    bodies.patches[p].part = part;
  }
  bodies.volumes.assign(count, 0.0);
  const Point<3>& origin = mesh.points[mesh.cells[cell][0]];
  for (int p = 0; p < polygons; ++p) {
    auto& polygon = bodies.polygons[p];
    polygon.part = part_of_root[sets.root(p)];
    if (polygon.part < 0) return false;
    bodies.volumes[polygon.part] +=
        area(polygon.shape) * normal(polygon.triangle).dot(polygon.shape.x[0] - origin) / 3;
  }
  for (const auto& patch : bodies.patches) {
    if (patch.local != 0) continue; // the others go through the origin
    const int f = cell_facets[0];
    const auto& facet = background_.facets().facets[f];
    const Point<3> gradient = barycentric_gradients(mesh, cell).col(0);
    const double facet_area = patch.index < 0 ? facet_measure(mesh, facet) : (*patches(f))[patch.index].area;
    bodies.volumes[patch.part] += facet_area / (3 * gradient.norm());
  }
  return true;
}

bool SpaceCells::fill(int cell, const FluidBodies& bodies, std::vector<ConvexFill::Simplex>& simplices) {
  const auto& mesh = background_.mesh();
  const Point<3> origin = mesh.points[mesh.cells[cell][0]];
  std::array<Point<3>, 4> corners;
  double extent = 0, farthest = origin.cwiseAbs().maxCoeff();
  for (int v = 0; v < 4; ++v) {
    corners[v] = mesh.points[mesh.cells[cell][v]] - origin;
    extent = std::max(extent, corners[v].norm());
    farthest = std::max(farthest, mesh.points[mesh.cells[cell][v]].cwiseAbs().maxCoeff());
  }
  to_fill_.resize(bodies.polygons.size());
  for (std::size_t p = 0; p < bodies.polygons.size(); ++p) {
    const auto& polygon = bodies.polygons[p];
    auto& record = to_fill_[p];
    record.shape = polygon.shape;
    for (int i = 0; i < record.shape.count; ++i) record.shape.x[i] -= origin;
    record.normal = normal(polygon.triangle);
    // From a corner in the cell: the triangle may reach far beyond it.
    record.offset = record.normal.dot(record.shape.x[0]);
    record.part = polygon.part;
  }
  constexpr double unit = std::numeric_limits<double>::epsilon();
  if (!filler_.fill(corners, to_fill_, 16 * unit * extent + 4 * unit * farthest)) return false;
  simplices = filler_.simplices();

  std::vector<double> missing = bodies.volumes;
  for (const auto& simplex : simplices) {
    const auto& x = simplex.x;
    missing[simplex.part] -= std::abs((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0])) / 6;
  }
  const double bound = fill_tolerance * cell_measure(mesh, cell);
  return std::all_of(missing.begin(), missing.end(), [&](double m) { return std::abs(m) <= bound; });
}

} // namespace undula::geometry
