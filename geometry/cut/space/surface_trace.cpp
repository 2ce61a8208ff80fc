#include "geometry/cut/space/surface_trace.hpp"

#include <algorithm>
#include <tuple>

#include "geometry/cut/space/orientation.hpp"

namespace undula::geometry {
namespace {

// Bounds of the error of a crossing in parts of its edge or facet (the error itself is a tenth or less): what
// a cell in floating point may have at all, and what it may have beside one in exact arithmetic.
constexpr double worst_crossing = 1e-11;
constexpr double good_crossing = 1e-13;

enum class Meeting { none, crossing, uncertain };

// Of a line with a triangle, by its orientations to the three edges.
Meeting meeting_of_line(std::array<int, 3> signs) {
  const auto [lowest, highest] = std::minmax_element(signs.begin(), signs.end());
  if (*lowest < 0 && *highest > 0) return Meeting::none;
  return *lowest > 0 || *highest < 0 ? Meeting::crossing : Meeting::uncertain;
}

template <class Record, class Key>
std::vector<int> ranges(const std::vector<Record>& sorted, std::size_t keys, const Key& key) {
  std::vector<int> first(keys + 1, 0);
  for (const auto& record : sorted) ++first[key(record) + 1];
  for (std::size_t i = 0; i < keys; ++i) first[i + 1] += first[i];
  return first;
}

class Tracer {
public:
  Tracer(const SpaceIndex& background, const SkinSurface& skin, std::span<const Point<3>> placed)
      : background_(background),
        mesh_(background.mesh()),
        facets_(background.facets()),
        skin_(skin),
        placed_(placed),
        point_seen_(mesh_.points.size(), -1),
        side_of_point_(mesh_.points.size()),
        edge_seen_(background.edges.size(), -1),
        facet_seen_(facets_.facets.size(), -1) {
    trace_.uncertain.assign(mesh_.cells.size(), 0);
  }

  SurfaceTrace run(std::span<const int> touching) {
    for (int t = 0; t < static_cast<int>(skin_.triangles.size()); ++t) meet_edges(t);
    for (int e = 0; e < static_cast<int>(skin_.edges.size()); ++e) meet_facets(e);
    locate_points();
    for (const int t : touching) mark_around(t);
    sort_crossings();
    list_segments();
    return std::move(trace_);
  }

private:
  const Point<3>& at(int point) const { return mesh_.points[point]; }
  const Point<3>& corner(int triangle, int i) const {
    return placed_[skin_.triangles[triangle].points[i % 3]];
  }

  Box<3> box_of(int triangle) const {
    const auto &a = corner(triangle, 0), &b = corner(triangle, 1), &c = corner(triangle, 2);
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  }

  // On which side of the plane of a triangle a point of the background lies, once per triangle.
  const Orientation& side_of_point(int triangle, int point) {
    if (point_seen_[point] != triangle) {
      point_seen_[point] = triangle;
      side_of_point_[point] =
          orientation(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2), at(point));
    }
    return side_of_point_[point];
  }

  bool plane_misses(int triangle, int cell) {
    int sum = 0;
    for (const int p : mesh_.cells[cell]) sum += side_of_point(triangle, p).sign();
    return std::abs(sum) == 4;
  }

  void meet_edges(int triangle) {
    const auto box = box_of(triangle);
    for (const int cell : background_.cell_grid().touching(box)) {
      if (plane_misses(triangle, cell)) continue;
      for (const int e : background_.cell_edges[cell]) {
        if (edge_seen_[e] == triangle) continue;
        edge_seen_[e] = triangle;
        meet_edge(triangle, e, box);
      }
    }
  }

  void meet_edge(int triangle, int e, const Box<3>& box) {
    const auto& [low, high] = background_.edges[e];
    const auto& at_low = side_of_point(triangle, low);
    const auto& at_high = side_of_point(triangle, high);
    if (at_low.sign() * at_high.sign() > 0) return;
    if (!box.touches({at(low).cwiseMin(at(high)), at(low).cwiseMax(at(high))})) return;
    std::array<int, 3> signs;
    for (int i = 0; i < 3; ++i)
      signs[i] = orientation(at(low), at(high), corner(triangle, i), corner(triangle, i + 1)).sign();
    const auto meeting = meeting_of_line(signs);
    if (meeting == Meeting::none) return;
    if (meeting == Meeting::uncertain || at_low.sign() == 0 || at_high.sign() == 0) return mark_edge(e);
    EdgeCrossing crossing;
    crossing.edge = e;
    crossing.triangle = triangle;
    const double sum = std::abs(at_low.value) + std::abs(at_high.value);
    crossing.t = std::abs(at_low.value) / sum;
    crossing.error = 2 * (at_low.error + at_high.error) / sum + 1e-15;
    // From the nearer end, so that a crossing close to a point keeps its distance from it.
    const Point<3> along = at(high) - at(low);
    crossing.x = crossing.t < 0.5 ? Point<3>(at(low) + crossing.t * along)
                                  : Point<3>(at(high) - std::abs(at_high.value) / sum * along);
    crossing.fluid_after = at_high.sign() < 0; // the normal points into the solid
    trace_.edge_crossings.push_back(crossing);
  }

  void meet_facets(int skin_edge) {
    const auto& a = placed_[skin_.edges[skin_edge].points[0]];
    const auto& b = placed_[skin_.edges[skin_edge].points[1]];
    const Box<3> box{a.cwiseMin(b), a.cwiseMax(b)};
    for (const int cell : background_.cell_grid().touching(box))
      for (const int f : background_.facets().cell_facets[cell]) {
        if (facet_seen_[f] == skin_edge) continue;
        facet_seen_[f] = skin_edge;
        meet_facet(skin_edge, f, a, b, box);
      }
  }

  void meet_facet(int skin_edge, int f, const Point<3>& a, const Point<3>& b, const Box<3>& box) {
    const auto& points = facets_.facets[f].points;
    const auto &p = at(points[0]), &q = at(points[1]), &r = at(points[2]);
    const Box<3> of_facet{p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
    if (!box.touches(of_facet)) return;
    const auto at_a = orientation(p, q, r, a), at_b = orientation(p, q, r, b);
    if (at_a.sign() * at_b.sign() > 0) return;
    const auto meeting = meeting_of_line(
        {orientation(p, q, a, b).sign(), orientation(q, r, a, b).sign(), orientation(r, p, a, b).sign()});
    if (meeting == Meeting::none) return;
    if (meeting == Meeting::uncertain || at_a.sign() == 0 || at_b.sign() == 0) return mark_beside(f);
    FacetCrossing crossing;
    crossing.facet = f;
    crossing.skin_edge = skin_edge;
    const double sum = std::abs(at_a.value) + std::abs(at_b.value);
    const double t = std::abs(at_a.value) / sum;
    const Point<3> along = b - a;
    crossing.error = (2 * (at_a.error + at_b.error) / sum + 1e-15) * along.norm() /
                     (of_facet.high - of_facet.low).maxCoeff();
    crossing.x = t < 0.5 ? Point<3>(a + t * along) : Point<3>(b - std::abs(at_b.value) / sum * along);
    trace_.facet_crossings.push_back(crossing);
  }

  void locate_points() {
    struct Located {
      int cell, point;
    };
    std::vector<Located> located;
    for (int point = 0; point < static_cast<int>(placed_.size()); ++point) {
      const auto& x = placed_[point];
      for (const int cell : background_.cell_grid().touching({x, x})) {
        int lowest = 1;
        for (int k = 0; k < 4 && lowest >= 0; ++k) {
          const int f = facets_.cell_facets[cell][k];
          const auto& facet = facets_.facets[f];
          const int sign =
              orientation(at(facet.points[0]), at(facet.points[1]), at(facet.points[2]), x).sign();
          const bool positive = (facet.cells[0] == cell ? 0 : 1) == background_.positive_cell[f];
          lowest = std::min(lowest, positive ? sign : -sign);
        }
        if (lowest > 0) located.push_back({cell, point});
        if (lowest == 0) trace_.uncertain[cell] = 1;
      }
    }
    std::sort(located.begin(), located.end(), [](const Located& a, const Located& b) {
      return std::tie(a.cell, a.point) < std::tie(b.cell, b.point);
    });
    trace_.first_point = ranges(located, mesh_.cells.size(), [](const Located& l) { return l.cell; });
    for (const auto& l : located) trace_.points_of_cells.push_back(l.point);
  }

  void mark_edge(int e) {
    for (int i = background_.first_cell[e]; i < background_.first_cell[e + 1]; ++i)
      trace_.uncertain[background_.cells_of_edges[i]] = 1;
  }

  void mark_beside(int facet) {
    for (const int cell : facets_.facets[facet].cells)
      if (cell >= 0) trace_.uncertain[cell] = 1;
  }

  // Marks the cells that the triangle may touch.
  void mark_around(int triangle) {
    for (const int cell : background_.cell_grid().touching(box_of(triangle)))
      if (!plane_misses(triangle, cell)) trace_.uncertain[cell] = 1;
  }

  void sort_crossings() {
    auto& on_edges = trace_.edge_crossings;
    std::sort(on_edges.begin(), on_edges.end(), [](const EdgeCrossing& a, const EdgeCrossing& b) {
      return std::tie(a.edge, a.t, a.triangle) < std::tie(b.edge, b.t, b.triangle);
    });
    trace_.first_on_edge =
        ranges(on_edges, background_.edges.size(), [](const EdgeCrossing& c) { return c.edge; });
    for (std::size_t i = 1; i < on_edges.size(); ++i) {
      const auto &here = on_edges[i - 1], &there = on_edges[i];
      if (here.edge == there.edge && there.t - here.t <= here.error + there.error) mark_edge(here.edge);
    }
    auto& on_facets = trace_.facet_crossings;
    std::sort(on_facets.begin(), on_facets.end(), [](const FacetCrossing& a, const FacetCrossing& b) {
      return std::tie(a.facet, a.skin_edge) < std::tie(b.facet, b.skin_edge);
    });
    trace_.first_on_facet =
        ranges(on_facets, facets_.facets.size(), [](const FacetCrossing& c) { return c.facet; });
    for (const auto& crossing : on_edges)
      if (crossing.error > worst_crossing) mark_edge(crossing.edge);
    for (const auto& crossing : on_facets)
      if (crossing.error > worst_crossing) mark_beside(crossing.facet);
  }

  // A triangle and a facet share a segment between two nodes, or nothing.
  void list_segments() {
    struct End {
      int facet, triangle;
      SkinNode node;
    };
    std::vector<End> ends;
    for (int c = 0; c < static_cast<int>(trace_.edge_crossings.size()); ++c) {
      const auto& crossing = trace_.edge_crossings[c];
      for (int i = background_.first_facet[crossing.edge]; i < background_.first_facet[crossing.edge + 1];
           ++i)
        ends.push_back(
            {background_.facets_of_edges[i], crossing.triangle, {SkinNode::Kind::edge_crossing, c}});
    }
    for (int c = 0; c < static_cast<int>(trace_.facet_crossings.size()); ++c)
      for (const int triangle : skin_.edges[trace_.facet_crossings[c].skin_edge].triangles)
        ends.push_back({trace_.facet_crossings[c].facet, triangle, {SkinNode::Kind::facet_crossing, c}});
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return std::tie(a.facet, a.triangle, a.node.kind, a.node.index) <
             std::tie(b.facet, b.triangle, b.node.kind, b.node.index);
    });
    for (std::size_t i = 0; i < ends.size();) {
      std::size_t j = i;
      while (j < ends.size() && ends[j].facet == ends[i].facet && ends[j].triangle == ends[i].triangle) ++j;
      if (j - i == 2)
        trace_.segments.push_back({ends[i].facet, ends[i].triangle, {ends[i].node, ends[i + 1].node}});
      else
        mark_beside(ends[i].facet);
      i = j;
    }
    trace_.first_segment =
        ranges(trace_.segments, facets_.facets.size(), [](const FacetSegment& s) { return s.facet; });
  }

  const SpaceIndex& background_;
  const SimplexMesh<3>& mesh_;
  const FacetTable<3>& facets_;
  const SkinSurface& skin_;
  std::span<const Point<3>> placed_;
  SurfaceTrace trace_;
  std::vector<int> point_seen_; // last triangle
  std::vector<Orientation> side_of_point_;
  std::vector<int> edge_seen_, facet_seen_; // last triangle, last edge of the skin
};

} // namespace

SurfaceTrace trace_surface(const SpaceIndex& background, const SkinSurface& skin,
                           std::span<const Point<3>> placed, std::span<const int> touching) {
  return Tracer(background, skin, placed).run(touching);
}

// Where the skin runs almost along an edge or a facet, rounding moves the crossing a long way. Cells in
// floating point share it and still close; beside a cell in exact arithmetic they would not.
void spread_uncertainty(const SpaceIndex& background, SurfaceTrace& trace) {
  std::vector<int> bad_edges, bad_facets;
  for (const auto& crossing : trace.edge_crossings)
    if (crossing.error > good_crossing) bad_edges.push_back(crossing.edge);
  for (const auto& crossing : trace.facet_crossings)
    if (crossing.error > good_crossing) bad_facets.push_back(crossing.facet);
  for (bool changed = true; changed;) {
    changed = false;
    const auto even_out = [&](const auto& cells) {
      bool some = false, all = true;
      for (const int cell : cells) {
        if (cell < 0) continue;
        some = some || trace.uncertain[cell] != 0;
        all = all && trace.uncertain[cell] != 0;
      }
      if (!some || all) return;
      for (const int cell : cells)
        if (cell >= 0) trace.uncertain[cell] = 1;
      changed = true;
    };
    for (const int e : bad_edges)
      even_out(
          std::span(background.cells_of_edges)
              .subspan(background.first_cell[e], background.first_cell[e + 1] - background.first_cell[e]));
    for (const int f : bad_facets) even_out(background.facets().facets[f].cells);
  }
}

} // namespace undula::geometry
