#include "geometry/cut/plane/plane_cut.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/cut/cut_checks.hpp"
#include "geometry/mesh/polygons.hpp"

namespace undula::geometry {

PlaneCut::PlaneCut(const Setup& setup, std::span<const SimplexMesh<2>> solids)
    : setup_(setup),
      placed_(place_skin(setup.skin, solids)),
      trace_(trace_skin(*setup.index, setup.skin, placed_, touching_segments(setup.skin, placed_))) {
  stretch_parts_.fill(std::vector<int>(setup.facets.facets.size() + trace_.crossings.size(), -1));
}

std::span<const int> PlaneCut::edges_of(int point) const {
  const auto& first = setup_.index->first_facet_of_point;
  return std::span(setup_.index->facets_of_points).subspan(first[point], first[point + 1] - first[point]);
}

bool PlaneCut::add_parts(int cell, std::span<const Side> side_of_point, CutMesh<2>& cut) {
  if (!passes_through(cell)) {
    if (side_of_point[cut.mesh.cells[cell][0]] == Side::fluid) {
      for (int v = 0; v < 3; ++v) set_stretch(cell, v, 0, static_cast<int>(cut.parts.size()));
      add_whole(cut, cell);
    }
    return true;
  }
  if (!find_fluid_polygons(*setup_.index, trace_, cell, polygons_)) throw CutContradiction{cell};
  const double element = cell_measure(cut.mesh, cell);
  if (!(std::abs(polygons_.fluid_area + polygons_.solid_area - element) <= closure_tolerance * element))
    throw CutContradiction{cell};
  const std::size_t begin = cut.simplices.size();
  std::array<int, 8> ends;
  if (polygons_.count > static_cast<int>(ends.size())) return false;
  for (int p = 0; p < polygons_.count; ++p) {
    if (!triangulate_polygon(polygons_.corners[p], cut.simplices) ||
        static_cast<int>(cut.simplices.size()) == (p ? ends[p - 1] : static_cast<int>(begin))) {
      cut.simplices.resize(begin);
      return false;
    }
    ends[p] = static_cast<int>(cut.simplices.size());
  }
  const int first = static_cast<int>(cut.parts.size());
  auto& quadrature = cut.volume_quadrature;
  int simplex = static_cast<int>(begin);
  for (int p = 0; p < polygons_.count; ++p) {
    auto& part = cut.parts.emplace_back(FluidPart{cell, true});
    part.simplex_begin = simplex;
    part.quadrature_begin = static_cast<int>(quadrature.weights.size());
    for (; simplex < ends[p]; ++simplex)
      append_simplex_quadrature<2, 2>(setup_.volume_rule, cut.simplices[simplex], quadrature);
    close_part(cut, part);
    part.simplex_end = simplex;
  }
  for (const auto& stretch : polygons_.stretches)
    set_stretch(cell, stretch.local, stretch.index, first + stretch.polygon);
  for (const auto& chain : polygons_.chains) add_skin(trace_.chains[chain.chain], first + chain.polygon, cut);
  return true;
}

void PlaneCut::add_skin(const SkinChain& chain, int part, CutMesh<2>& cut) const {
  for (int i = chain.first; i >= 0; i = trace_.pieces[i].next) {
    const auto& piece = trace_.pieces[i];
    const auto& segment = setup_.skin.segments[piece.segment];
    const Point<2> along = (placed_[piece.segment].b - placed_[piece.segment].a).normalized();
    InterfacePiece<2> record{part, segment.solid, segment.cell, Point<2>(-along[1], along[0]), 0, 0};
    auto& set = cut.interface_quadrature;
    record.quadrature_begin = static_cast<int>(set.weights.size());
    append_simplex_quadrature<2, 1>(setup_.interface_rule, std::array{piece.from, piece.to}, set);
    record.quadrature_end = static_cast<int>(set.weights.size());
    cut.interface.push_back(record);
  }
}

// Stretches of a facet are the pieces between its crossings from low to high.
void PlaneCut::set_stretch(int cell, int local, int index, int part) {
  const int facet = setup_.facets.cell_facets[cell][local];
  stretch_parts_[setup_.facets.facets[facet].cells[0] == cell ? 0 : 1][first_stretch(facet) + index] = part;
}

double PlaneCut::stretch_measure(int facet, int index) const {
  const int last = trace_.count(facet);
  const double begin = index == 0 ? 0 : trace_.at(facet, index - 1).t;
  const double end = index == last ? 1 : trace_.at(facet, index).t;
  return (end - begin) * setup_.shapes[facet].measure;
}

// Part on each stretch of a facet (-1: solid), seen from one of its cells.
std::vector<int> PlaneCut::parts_on_stretches(int facet, int k, const ExactCells<2>& exact,
                                              const CutMesh<2>& cut) const {
  const int count = trace_.count(facet) + 1;
  const int cell = cut.facets.facets[facet].cells[k];
  if (!exact.has(cell)) {
    const auto begin = stretch_parts_[k].begin() + first_stretch(facet);
    return {begin, begin + count};
  }
  // The exact traces, in order, merged where they meet; there is one on every fluid stretch.
  const auto& low_end = cut.mesh.points[low(facet)];
  const auto& high_end = cut.mesh.points[high(facet)];
  const int axis = std::abs(high_end[0] - low_end[0]) >= std::abs(high_end[1] - low_end[1]) ? 0 : 1;
  const bool rising = high_end[axis] > low_end[axis];
  struct Run {
    Exact begin, end;
    int part;
  };
  std::vector<Run> runs;
  for (const auto& trace : exact.at(cell).traces[cut.facets.facets[facet].local[k]]) {
    Exact a = trace.shape.vertices[0].x[axis], b = trace.shape.vertices[1].x[axis];
    if (!rising) {
      a = -a;
      b = -b;
    }
    runs.push_back({std::min(a, b), std::max(a, b), cut.cell_parts[cell] + trace.part});
  }
  std::sort(runs.begin(), runs.end(), [](const Run& p, const Run& q) { return p.begin < q.begin; });
  std::vector<int> merged;
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (r == 0 || runs[r].part != runs[r - 1].part || runs[r].begin != runs[r - 1].end)
      merged.push_back(runs[r].part);
  const bool fluid_first = count == 1 ? !merged.empty() : !trace_.at(facet, 0).fluid_after;
  std::vector<int> parts(count, -1);
  std::size_t next = 0;
  for (int i = fluid_first ? 0 : 1; i < count; i += 2) parts[i] = next < merged.size() ? merged[next++] : -2;
  if (next != merged.size()) parts[0] = -2; // as many traces as fluid stretches, or they do not match
  return parts;
}

void PlaneCut::connect(int facet, const ExactCells<2>& exact, CutMesh<2>& cut) {
  const std::size_t begin = cut.connections.size();
  const auto& cells = cut.facets.facets[facet].cells;
  if (!exact.has(cells[0]) && !exact.has(cells[1])) {
    for (int i = 0; i <= trace_.count(facet); ++i) {
      const int stretch = first_stretch(facet) + i;
      const int a = stretch_parts_[0][stretch], b = stretch_parts_[1][stretch];
      if ((a < 0) != (b < 0)) throw CutContradiction{cells[0]};
      if (a >= 0) add_connection(cut, begin, facet, {a, b}, stretch_measure(facet, i));
    }
    return;
  }
  const auto first = parts_on_stretches(facet, 0, exact, cut),
             second = parts_on_stretches(facet, 1, exact, cut);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if ((first[i] < 0) != (second[i] < 0) || first[i] < -1 || second[i] < -1)
      throw CutContradiction{cells[0]};
    if (first[i] >= 0)
      add_connection(cut, begin, facet, {first[i], second[i]}, stretch_measure(facet, static_cast<int>(i)));
  }
}

void PlaneCut::add_boundary(int facet, CutMesh<2>& cut) const {
  add_boundary_pieces(cut, facet, [&](int part) {
    const int last = trace_.count(facet);
    for (int i = 0; i <= last; ++i) {
      if (stretch_parts_[0][first_stretch(facet) + i] != part) continue;
      const auto& begin = i == 0 ? cut.mesh.points[low(facet)] : trace_.at(facet, i - 1).x;
      const auto& end = i == last ? cut.mesh.points[high(facet)] : trace_.at(facet, i).x;
      append_simplex_quadrature<2, 1>(setup_.boundary_rule, std::array{begin, end}, cut.boundary_quadrature);
    }
  });
}

} // namespace undula::geometry
