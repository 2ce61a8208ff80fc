#include "geometry/cut/plane/skin_walk.hpp"

#include <algorithm>
#include <string>

#include "geometry/cut/plane/orientation.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

std::vector<Box<2>> cell_boxes(const SimplexMesh<2>& mesh) {
  std::vector<Box<2>> boxes;
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) boxes.push_back(cell_box(mesh, c));
  return boxes;
}

std::vector<Box<2>> facet_boxes(const SimplexMesh<2>& mesh, const FacetTable<2>& table,
                                const std::vector<int>& facets) {
  std::vector<Box<2>> boxes;
  for (const int f : facets) {
    const auto& p = mesh.points[table.facets[f].points[0]];
    const auto& q = mesh.points[table.facets[f].points[1]];
    boxes.push_back({p.cwiseMin(q), p.cwiseMax(q)});
  }
  return boxes;
}

std::vector<int> one_sided(const FacetTable<2>& table) {
  std::vector<int> facets;
  for (int f = 0; f < static_cast<int>(table.facets.size()); ++f)
    if (table.facets[f].cells[1] < 0) facets.push_back(f);
  return facets;
}

// Bounds of the error of a crossing in parts of its facet (the error itself is a tenth or less): what a cell
// in floating point may have at all, and what it may have beside one in exact arithmetic.
constexpr double worst_crossing = 1e-11;
constexpr double good_crossing = 1e-13;

constexpr int outside = -1;
constexpr int unknown = -2;

class Walk {
public:
  Walk(const BackgroundIndex& background, const SolidSkin& skin, std::span<const PlacedSegment> placed)
      : background_(background),
        mesh_(background.mesh()),
        facets_(background.facets()),
        skin_(skin),
        placed_(placed) {
    trace_.first_chain.assign(mesh_.cells.size(), -1);
    trace_.uncertain.assign(mesh_.cells.size(), 0);
  }

  SkinTrace run(std::span<const int> touching) {
    for (std::size_t line = 0; line + 1 < skin_.lines.size(); ++line)
      walk_line(skin_.lines[line], skin_.lines[line + 1]);
    for (const int segment : touching) mark_around(segment);
    list_chains();
    sort_crossings();
    spread_uncertainty();
    return std::move(trace_);
  }

private:
  const Point<2>& corner(int cell, int local) const { return mesh_.points[mesh_.cells[cell][local % 3]]; }

  void walk_line(int begin, int end) {
    open_ = -1;
    int head = -1; // the chain that starts at the first point of the line, inside a cell
    int place = unknown;
    for (int s = begin; s < end; ++s) {
      if (place == unknown && !skin_.segments[s].pinched) {
        place = locate(placed_[s].a);
        open_ = place >= 0 ? start_chain(place, -1) : -1;
        if (s == begin) head = open_;
      }
      if (place == unknown || skin_.segments[s].pinched || !walk_segment(s, place)) {
        mark_around(s);
        place = unknown;
        open_ = -1;
      }
    }
    if (place < 0 || open_ < 0) return;
    if (open_ == head) {
      trace_.uncertain[place] = 1; // a solid (or a hole of one) inside one cell
    } else if (head >= 0 && trace_.chains[head].cell == place) {
      auto& tail = trace_.chains[open_];
      trace_.pieces[tail.last].next = trace_.chains[head].first;
      trace_.chains[head].first = tail.first;
      trace_.chains[head].entry = tail.entry;
      if (tail.entry >= 0) trace_.crossings[tail.entry].chain = head;
      tail.cell = -1;
    }
  }

  // Cell that contains x in its interior, `outside`, or `unknown` if x is too near to a facet.
  int locate(const Point<2>& x) const {
    bool certain = true;
    for (const int cell : background_.cell_grid().touching({x, x})) {
      int lowest = 1;
      for (int k = 0; k < 3; ++k)
        lowest = std::min(lowest, orientation(corner(cell, k), corner(cell, k + 1), x).sign());
      if (lowest > 0) return cell;
      if (lowest == 0) certain = false;
    }
    return certain ? outside : unknown;
  }

  // Walks a segment that starts in `place`, and sets `place` to where it ends. False if a sign is uncertain.
  bool walk_segment(int segment, int& place) {
    bool leaves = place == outside;
    if (place >= 0) {
      if (!walk_cells(segment, place, -1, placed_[segment].a)) return false;
      leaves = place == outside;
    }
    if (!leaves) return true;
    const auto& [a, b] = placed_[segment];
    for (const int f : background_.boundary_near({a.cwiseMin(b), a.cwiseMax(b)})) {
      const auto& low = mesh_.points[background_.low(f)];
      const auto& high = mesh_.points[background_.high(f)];
      const auto to_low = orientation(a, b, low), to_high = orientation(a, b, high);
      const int ends = to_low.sign() * to_high.sign();
      if (ends > 0) continue;
      const int inward = background_.forward(f, 0) ? 1 : -1;
      const int from = inward * orientation(low, high, a).sign();
      const int to = inward * orientation(low, high, b).sign();
      if (from * to > 0) continue;
      if (ends == 0 || from * to == 0) return false;
      if (from > 0) continue; // the way out, which the walk from inside has taken
      const int crossing = add_crossing(f, 0, to_low, to_high);
      int cell = facets_.facets[f].cells[0];
      const int chain = start_chain(cell, crossing);
      open_ = chain;
      if (!walk_cells(segment, cell, facets_.facets[f].local[0], trace_.crossings[crossing].x)) return false;
      if (cell >= 0) {
        place = cell;
        reached_ = open_;
      }
    }
    open_ = place >= 0 ? reached_ : -1;
    return true;
  }

  // Follows the segment from x in `cell`, entered through the facet opposite `from` (-1: starts inside), to
  // its end; `cell` becomes the last cell, or `outside`.
  bool walk_cells(int segment, int& cell, int from, Point<2> x) {
    const auto& [a, b] = placed_[segment];
    for (std::size_t steps = 0; steps <= mesh_.cells.size(); ++steps) {
      int beyond[3]; // on which side of the facet opposite k the end lies
      bool inside = true;
      for (int k = 0; k < 3; ++k) {
        beyond[k] = k == from ? 1 : orientation(corner(cell, k + 1), corner(cell, k + 2), b).sign();
        inside = inside && beyond[k] > 0;
      }
      if (inside) {
        add_piece(segment, x, b);
        return true;
      }
      Orientation of_corner[3];
      for (int k = 0; k < 3; ++k) of_corner[k] = orientation(a, b, corner(cell, k));
      int exit = -1;
      for (int k = 0; k < 3; ++k) {
        if (of_corner[k].sign() == 0) return false;
        if (of_corner[(k + 1) % 3].sign() < 0 && of_corner[(k + 2) % 3].sign() > 0) exit = k;
      }
      if (exit < 0 || exit == from || beyond[exit] >= 0) return false;
      const int f = facets_.cell_facets[cell][exit];
      const auto& facet = facets_.facets[f];
      const int side = facet.cells[0] == cell ? 0 : 1;
      const bool first_is_low = background_.forward(f, side);
      const int crossing = add_crossing(f, 1 - side, of_corner[(exit + (first_is_low ? 1 : 2)) % 3],
                                        of_corner[(exit + (first_is_low ? 2 : 1)) % 3]);
      add_piece(segment, x, trace_.crossings[crossing].x);
      trace_.chains[open_].exit = crossing;
      open_ = -1;
      x = trace_.crossings[crossing].x;
      cell = facet.cells[1 - side];
      if (cell < 0) {
        cell = outside;
        return true;
      }
      from = facet.local[1 - side];
      open_ = start_chain(cell, crossing);
    }
    return false;
  }

  int start_chain(int cell, int entry) {
    const int chain = static_cast<int>(trace_.chains.size());
    auto& record = trace_.chains.emplace_back();
    record.cell = cell;
    record.entry = entry;
    if (entry >= 0) trace_.crossings[entry].chain = chain;
    return chain;
  }

  void add_piece(int segment, const Point<2>& from, const Point<2>& to) {
    const int piece = static_cast<int>(trace_.pieces.size());
    trace_.pieces.push_back({segment, from, to, -1});
    auto& chain = trace_.chains[open_];
    (chain.first < 0 ? chain.first : trace_.pieces[chain.last].next) = piece;
    chain.last = piece;
  }

  int add_crossing(int facet, int into, const Orientation& to_low, const Orientation& to_high) {
    SkinCrossing crossing;
    crossing.facet = facet;
    crossing.into = into;
    const double sum = std::abs(to_low.value) + std::abs(to_high.value);
    crossing.t = std::abs(to_low.value) / sum;
    crossing.error = 2 * (to_low.error + to_high.error) / sum + 1e-15;
    const auto& low = mesh_.points[background_.low(facet)];
    const auto& high = mesh_.points[background_.high(facet)];
    // From the nearer end, so that a crossing close to a corner keeps its distance from it.
    const Point<2> along = high - low;
    crossing.x = crossing.t < 0.5 ? Point<2>(low + crossing.t * along)
                                  : Point<2>(high - std::abs(to_high.value) / sum * along);
    // The solid is at the left of the skin: counter-clockwise around the cell it enters, fluid follows.
    crossing.fluid_after = background_.forward(facet, into);
    trace_.crossings.push_back(crossing);
    return static_cast<int>(trace_.crossings.size()) - 1;
  }

  // Marks the cells that the segment may touch.
  void mark_around(int segment) {
    const auto& [a, b] = placed_[segment];
    for (const int cell : background_.cell_grid().touching({a.cwiseMin(b), a.cwiseMax(b)})) {
      if (trace_.uncertain[cell]) continue;
      int sum = 0;
      for (int k = 0; k < 3; ++k) sum += orientation(a, b, corner(cell, k)).sign();
      bool apart = std::abs(sum) == 3;
      for (int k = 0; k < 3 && !apart; ++k)
        apart = orientation(corner(cell, k), corner(cell, k + 1), a).sign() < 0 &&
                orientation(corner(cell, k), corner(cell, k + 1), b).sign() < 0;
      if (!apart) trace_.uncertain[cell] = 1;
    }
  }

  void list_chains() {
    for (int c = static_cast<int>(trace_.chains.size()) - 1; c >= 0; --c) {
      auto& chain = trace_.chains[c];
      if (chain.cell < 0) continue;
      chain.next_in_cell = trace_.first_chain[chain.cell];
      trace_.first_chain[chain.cell] = c;
      if (chain.entry < 0 || chain.exit < 0) trace_.uncertain[chain.cell] = 1;
    }
  }

  void sort_crossings() {
    auto& first = trace_.facet_crossings;
    first.assign(facets_.facets.size() + 1, 0);
    for (const auto& crossing : trace_.crossings) ++first[crossing.facet + 1];
    for (std::size_t f = 0; f < facets_.facets.size(); ++f) first[f + 1] += first[f];
    trace_.sorted.resize(trace_.crossings.size());
    auto next = first;
    for (int c = 0; c < static_cast<int>(trace_.crossings.size()); ++c)
      trace_.sorted[next[trace_.crossings[c].facet]++] = c;
    for (int f = 0; f < static_cast<int>(facets_.facets.size()); ++f) {
      if (trace_.count(f) < 2) continue;
      std::sort(trace_.sorted.begin() + first[f], trace_.sorted.begin() + first[f + 1],
                [&](int a, int b) { return trace_.crossings[a].t < trace_.crossings[b].t; });
      for (int i = 0; i + 1 < trace_.count(f); ++i) {
        const auto &here = trace_.at(f, i), &there = trace_.at(f, i + 1);
        if (there.t - here.t <= here.error + there.error) mark_beside(f);
      }
    }
  }

  void mark_beside(int facet) {
    for (const int cell : facets_.facets[facet].cells)
      if (cell >= 0) trace_.uncertain[cell] = 1;
  }

  // Where the skin runs almost along a facet, rounding moves the crossing a long way. Cells in floating point
  // share it and still close; beside a cell in exact arithmetic they would not.
  void spread_uncertainty() {
    for (const auto& crossing : trace_.crossings)
      if (crossing.error > worst_crossing) mark_beside(crossing.facet);
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& crossing : trace_.crossings) {
        const auto& cells = facets_.facets[crossing.facet].cells;
        if (crossing.error <= good_crossing || cells[1] < 0 ||
            trace_.uncertain[cells[0]] == trace_.uncertain[cells[1]])
          continue;
        mark_beside(crossing.facet);
        changed = true;
      }
    }
  }

  const BackgroundIndex& background_;
  const SimplexMesh<2>& mesh_;
  const FacetTable<2>& facets_;
  const SolidSkin& skin_;
  std::span<const PlacedSegment> placed_;
  SkinTrace trace_;
  int open_ = -1;    // chain that the walk is extending
  int reached_ = -1; // chain in which the segment from outside has ended
};

} // namespace

BackgroundIndex::BackgroundIndex(const SimplexMesh<2>& mesh, const FacetTable<2>& facets)
    : mesh_(&mesh),
      facets_(&facets),
      cell_grid_(cell_boxes(mesh)),
      boundary_grid_(facet_boxes(mesh, facets, one_sided(facets))),
      boundary_facets_(one_sided(facets)) {
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) {
    const auto& v = mesh.cells[c];
    if (exact_orientation(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]) <= 0)
      throw NumericsError("a cell of a mesh to be cut is flat or inverted",
                          "cell " + std::to_string(c) + " of the background mesh",
                          "a mesh whose cells are all positively oriented");
  }
  first_facet_of_point.assign(mesh.points.size() + 1, 0);
  for (const auto& facet : facets.facets) {
    int low = facet.points[0], high = facet.points[1];
    const auto &p = mesh.points[low], &q = mesh.points[high];
    if (q[0] < p[0] || (q[0] == p[0] && q[1] < p[1])) std::swap(low, high);
    ends_.push_back({low, high});
    forward_.push_back(mesh.cells[facet.cells[0]][(facet.local[0] + 1) % 3] == low);
    for (const int point : facet.points) ++first_facet_of_point[point + 1];
  }
  for (std::size_t p = 0; p < mesh.points.size(); ++p) first_facet_of_point[p + 1] += first_facet_of_point[p];
  facets_of_points.resize(first_facet_of_point.back());
  auto next = first_facet_of_point;
  for (int f = 0; f < static_cast<int>(facets.facets.size()); ++f)
    for (const int point : facets.facets[f].points) facets_of_points[next[point]++] = f;
}

std::vector<int> BackgroundIndex::boundary_near(const Box<2>& box) const {
  auto found = boundary_grid_.touching(box);
  for (int& f : found) f = boundary_facets_[f];
  return found;
}

SkinTrace trace_skin(const BackgroundIndex& background, const SolidSkin& skin,
                     std::span<const PlacedSegment> placed, std::span<const int> touching) {
  return Walk(background, skin, placed).run(touching);
}

} // namespace undula::geometry
