#include "geometry/cut/space/facet_patches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh/polygons.hpp"

namespace undula::geometry {
namespace {

// A crossing of an edge of the facet, seen along its outline. Edge e joins the points e and e + 1.
struct Event {
  int crossing;
  int edge;
  int rank;   // among the crossings of the edge, along the outline
  bool entry; // solid before, fluid after
};

// Even-odd rule in the plane along two axes.
bool surrounds(const std::vector<Point<3>>& polygon, int u, int v, const Point<3>& x) {
  bool odd = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto &a = polygon[i], &b = polygon[j];
    if ((a[v] > x[v]) != (b[v] > x[v]) && x[u] < a[u] + (x[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u]))
      odd = !odd;
  }
  return odd;
}

class FacetWalk {
public:
  FacetWalk(const SpaceIndex& background, const SkinSurface& skin, std::span<const Point<3>> placed,
            const SurfaceTrace& trace, int facet)
      : background_(background),
        skin_(skin),
        placed_(placed),
        trace_(trace),
        facet_(facet),
        begin_(trace.first_segment[facet]),
        end_(trace.first_segment[facet + 1]),
        used_(end_ - begin_, 0) {
    const auto& points = background.facets().facets[facet].points;
    for (int i = 0; i < 3; ++i) corners_[i] = background.mesh().points[points[i]];
    normal_ = (corners_[1] - corners_[0]).cross(corners_[2] - corners_[0]).normalized();
    for (int e = 0; e < 3; ++e) {
      edges_[e] = background.facet_edges[facet][e];
      forward_[e] = background.edges[edges_[e]].low == points[e];
      count_[e] = trace.count(edges_[e]);
    }
  }

  std::optional<std::vector<FacetPatch>> patches() {
    if (!list_events() || !walk_outlines() || !add_loops()) return std::nullopt;
    for (auto& patch : patches_) {
      Point<3> twice = twice_area(patch.outline);
      for (const auto& hole : patch.holes) twice += twice_area(hole);
      patch.area = twice.dot(normal_) / 2;
      if (!(patch.area > 0)) return std::nullopt;
    }
    return std::move(patches_);
  }

private:
  bool list_events() {
    for (int e = 0; e < 3; ++e)
      for (int rank = 0; rank < count_[e]; ++rank) {
        const int crossing = trace_.first_on_edge[edges_[e]] + (forward_[e] ? rank : count_[e] - 1 - rank);
        const bool fluid_after = trace_.edge_crossings[crossing].fluid_after;
        events_.push_back({crossing, e, rank, forward_[e] ? fluid_after : !fluid_after});
      }
    const int n = static_cast<int>(events_.size());
    if (n % 2 == 1) return false;
    for (int i = 0; i < n; ++i)
      if (events_[i].entry == events_[(i + 1) % n].entry) return false;
    return true;
  }

  const Point<3>& position(const SkinNode& node) const {
    return node.kind == SkinNode::Kind::edge_crossing ? trace_.edge_crossings[node.index].x
                                                      : trace_.facet_crossings[node.index].x;
  }

  // The unused segment at a node; -1 if there is none.
  int segment_at(const SkinNode& node) const {
    for (int s = begin_; s < end_; ++s)
      if (!used_[s - begin_] && (trace_.segments[s].ends[0] == node || trace_.segments[s].ends[1] == node))
        return s;
    return -1;
  }

  // Follows the skin from a node as long as it goes on, and returns the last node. Appends all but it.
  SkinNode follow(SkinNode node, std::vector<Point<3>>& outline, std::vector<int>& segments) {
    for (int s = segment_at(node); s >= 0; s = segment_at(node)) {
      used_[s - begin_] = 1;
      segments.push_back(s);
      outline.push_back(position(node));
      const auto& ends = trace_.segments[s].ends;
      node = ends[0] == node ? ends[1] : ends[0];
      if (node.kind == SkinNode::Kind::edge_crossing) break;
    }
    return node;
  }

  void add_stretch(FacetPatch& patch, int edge, int rank) const {
    patch.stretches.push_back({edges_[edge], forward_[edge] ? rank : count_[edge] - rank});
  }

  bool walk_outlines() {
    const int n = static_cast<int>(events_.size());
    std::vector<char> done(n, 0);
    for (int start = 0; start < n; ++start) {
      if (!events_[start].entry || done[start]) continue;
      FacetPatch patch;
      for (int at = start; !done[at];) {
        done[at] = 1;
        patch.outline.push_back(trace_.edge_crossings[events_[at].crossing].x);
        const int next = (at + 1) % n;
        int edge = events_[at].edge;
        add_stretch(patch, edge, events_[at].rank + 1);
        for (int left = events_[next].edge - edge + (next <= at ? 3 : 0); left > 0; --left) {
          edge = (edge + 1) % 3;
          patch.outline.push_back(corners_[edge]);
          add_stretch(patch, edge, 0);
        }
        const SkinNode out{SkinNode::Kind::edge_crossing, events_[next].crossing};
        const SkinNode in = follow(out, patch.outline, patch.segments);
        if (in == out || in.kind != SkinNode::Kind::edge_crossing) return false;
        const auto found = std::find_if(events_.begin(), events_.end(),
                                        [&](const Event& e) { return e.crossing == in.index; });
        if (found == events_.end() || !found->entry) return false;
        at = static_cast<int>(found - events_.begin());
        if (done[at] && at != start) return false;
      }
      patches_.push_back(std::move(patch));
    }
    return true;
  }

  // Whether the fluid lies at the left of a loop, seen against the normal; nothing if rounding hides it.
  std::optional<bool> fluid_at_left(const std::vector<Point<3>>& loop,
                                    const std::vector<int>& segments) const {
    double sum = 0, length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point<3> along = loop[(i + 1) % loop.size()] - loop[i];
      const auto& points = skin_.triangles[trace_.segments[segments[i]].triangle].points;
      const Point<3> into_solid = (placed_[points[1]] - placed_[points[0]])
                                      .cross(placed_[points[2]] - placed_[points[0]])
                                      .normalized();
      const Point<3> in_plane = into_solid - into_solid.dot(normal_) * normal_;
      if (in_plane.norm() < 1e-6) continue; // the triangle lies almost in the facet
      sum -= normal_.cross(along).dot(in_plane.normalized());
      length += along.norm();
    }
    if (!(std::abs(sum) > 0.9 * length)) return std::nullopt;
    return sum > 0;
  }

  // Closed lines of the skin: islands of fluid, or holes.
  bool add_loops() {
    std::vector<FacetPatch> holes;
    for (int s = begin_; s < end_; ++s) {
      if (used_[s - begin_]) continue;
      FacetPatch loop;
      const SkinNode start = trace_.segments[s].ends[0];
      if (start.kind == SkinNode::Kind::edge_crossing) return false;
      if (!(follow(start, loop.outline, loop.segments) == start)) return false;
      const double twice = twice_area(loop.outline).dot(normal_);
      double extent = 0;
      for (const auto& x : loop.outline) extent = std::max(extent, (x - loop.outline[0]).squaredNorm());
      if (!(std::abs(twice) > 1e-12 * extent)) return false;
      const auto left = fluid_at_left(loop.outline, loop.segments);
      if (!left) return false;
      const bool island = *left == (twice > 0);
      // Counter-clockwise around fluid, clockwise around a hole.
      if (!*left) std::reverse(loop.outline.begin(), loop.outline.end());
      (island ? patches_ : holes).push_back(std::move(loop));
    }
    if (events_.empty() && !holes.empty()) {
      FacetPatch whole;
      whole.outline.assign(corners_.begin(), corners_.end());
      for (int e = 0; e < 3; ++e) add_stretch(whole, e, 0);
      patches_.push_back(std::move(whole));
    }
    int axis;
    normal_.cwiseAbs().maxCoeff(&axis);
    for (auto& hole : holes) {
      FacetPatch* around = nullptr;
      double least = std::numeric_limits<double>::infinity();
      for (auto& patch : patches_) {
        const double area = twice_area(patch.outline).dot(normal_);
        if (area < least && surrounds(patch.outline, (axis + 1) % 3, (axis + 2) % 3, hole.outline[0])) {
          around = &patch;
          least = area;
        }
      }
      if (!around) return false;
      around->segments.insert(around->segments.end(), hole.segments.begin(), hole.segments.end());
      around->holes.push_back(std::move(hole.outline));
    }
    return true;
  }

  const SpaceIndex& background_;
  const SkinSurface& skin_;
  std::span<const Point<3>> placed_;
  const SurfaceTrace& trace_;
  int facet_, begin_, end_;
  std::vector<char> used_; // segments
  std::array<Point<3>, 3> corners_;
  Point<3> normal_;
  std::array<int, 3> edges_, count_;
  std::array<bool, 3> forward_;
  std::vector<Event> events_;
  std::vector<FacetPatch> patches_;
};

} // namespace

std::optional<std::vector<FacetPatch>> find_patches(const SpaceIndex& background, const SkinSurface& skin,
                                                    std::span<const Point<3>> placed,
                                                    const SurfaceTrace& trace, int facet) {
  return FacetWalk(background, skin, placed, trace, facet).patches();
}

bool patch_contains(const FacetPatch& patch, const Point<3>& normal, const Point<3>& x) {
  int axis;
  normal.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (!surrounds(patch.outline, u, v, x)) return false;
  return std::none_of(patch.holes.begin(), patch.holes.end(),
                      [&](const auto& hole) { return surrounds(hole, u, v, x); });
}

bool append_patch_quadrature(const FacetPatch& patch, const ReferenceRule<2>& rule, QuadratureSet<3>& set) {
  const Point<3> normal = twice_area(patch.outline).normalized();
  const Point<3> origin = patch.outline[0];
  Point<3> first = Point<3>::Zero();
  for (const auto& x : patch.outline)
    if ((x - origin).squaredNorm() > first.squaredNorm()) first = x - origin;
  first.normalize();
  const Point<3> second = normal.cross(first);
  std::vector<Point<2>> corners;
  for (const auto& x : patch.outline) corners.emplace_back(first.dot(x - origin), second.dot(x - origin));
  std::vector<std::array<Point<2>, 3>> triangles;
  if (!triangulate_polygon(corners, triangles)) return false;
  for (const auto& triangle : triangles) {
    std::array<Point<3>, 3> x;
    for (int i = 0; i < 3; ++i) x[i] = origin + triangle[i][0] * first + triangle[i][1] * second;
    append_simplex_quadrature<3, 2>(rule, x, set);
  }
  return true;
}

Point<3> twice_area(const std::vector<Point<3>>& polygon) {
  Point<3> twice = Point<3>::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return twice;
}

} // namespace undula::geometry
