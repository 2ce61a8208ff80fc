#include "geometry/cut/space/space_cut.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/cut/cut_checks.hpp"

namespace undula::geometry {

SpaceCut::SpaceCut(const Setup& setup, std::span<const SimplexMesh<3>> solids)
    : setup_(setup),
      space_(*setup.space, setup.surface, place_surface(setup.surface, solids)),
      facet_parts_(setup.facets.facets.size(), {-1, -1}) {}

std::span<const int> SpaceCut::cells(int edge) const {
  const auto& first = setup_.space->first_cell;
  return std::span(setup_.space->cells_of_edges).subspan(first[edge], first[edge + 1] - first[edge]);
}

std::span<const int> SpaceCut::edges_of(int point) const {
  const auto& first = setup_.space->first_edge;
  return std::span(setup_.space->edges_of_points).subspan(first[point], first[point + 1] - first[point]);
}

// The part on a facet of a cell that the skin does not meet.
void SpaceCut::set_part(int cell, int local, int part) {
  const int facet = setup_.facets.cell_facets[cell][local];
  facet_parts_[facet][setup_.facets.facets[facet].cells[0] == cell ? 0 : 1] = part;
}

bool SpaceCut::add_parts(int cell, std::span<const Side> side_of_point, CutMesh<3>& cut) {
  const auto is_fluid = [&](int point) { return side_of_point[point] == Side::fluid; };
  const int first = static_cast<int>(cut.parts.size());
  if (!passes_through(cell)) {
    if (!is_fluid(cut.mesh.cells[cell][0])) return true;
    for (int v = 0; v < 4; ++v) set_part(cell, v, first);
    add_whole(cut, cell);
    return true;
  }
  if (!space_.find_bodies(cell, is_fluid, bodies_) || !space_.fill(cell, bodies_, simplices_)) return false;
  const int count = static_cast<int>(bodies_.volumes.size());
  std::vector<int> simplices_of(count, 0);
  for (const auto& simplex : simplices_) ++simplices_of[simplex.part];
  if (std::find(simplices_of.begin(), simplices_of.end(), 0) != simplices_of.end()) return false;

  const Point<3>& origin = cut.mesh.points[cut.mesh.cells[cell][0]];
  for (int p = 0; p < count; ++p) {
    auto& part = cut.parts.emplace_back(FluidPart{cell, true});
    part.simplex_begin = static_cast<int>(cut.simplices.size());
    part.quadrature_begin = static_cast<int>(cut.volume_quadrature.weights.size());
    for (const auto& simplex : simplices_) {
      if (simplex.part != p) continue;
      auto& x = cut.simplices.emplace_back(simplex.x);
      for (auto& corner : x) corner += origin;
      append_simplex_quadrature<3, 3>(setup_.volume_rule, x, cut.volume_quadrature);
    }
    close_part(cut, part);
  }
  for (const auto& patch : bodies_.patches) {
    const int facet = setup_.facets.cell_facets[cell][patch.local];
    if (patch.index < 0)
      set_part(cell, patch.local, first + patch.part);
    else
      (*space_.patches(facet))[patch.index].parts[setup_.facets.facets[facet].cells[0] == cell ? 0 : 1] =
          first + patch.part;
  }
  for (const auto& polygon : bodies_.polygons) add_skin(polygon, first + polygon.part, cut);
  return true;
}

void SpaceCut::add_skin(const FluidBodies::Polygon& polygon, int part, CutMesh<3>& cut) const {
  const auto& triangle = setup_.surface.triangles[polygon.triangle];
  InterfacePiece<3> record{part, triangle.solid, triangle.cell, space_.normal(polygon.triangle), 0, 0};
  auto& set = cut.interface_quadrature;
  record.quadrature_begin = static_cast<int>(set.weights.size());
  const auto& x = polygon.shape.x;
  for (int i = 1; i + 1 < polygon.shape.count; ++i)
    append_simplex_quadrature<3, 2>(setup_.interface_rule, std::array{x[0], x[i], x[i + 1]}, set);
  record.quadrature_end = static_cast<int>(set.weights.size());
  cut.interface.push_back(record);
}

// The parts of a cell in exact arithmetic on the patches of its facet.
void SpaceCut::find_exact_parts(int index, int k, const ExactCells<3>& exact, const CutMesh<3>& cut,
                                std::vector<FacetPatch>& patches) const {
  const auto& facet = cut.facets.facets[index];
  const auto& near = exact.at(facet.cells[k]);
  struct Sum {
    double area = 0, largest = 0;
    int part = -1;
  };
  std::vector<Sum> sums(patches.size());
  struct Stray {
    Point<3> middle;
    int part;
  };
  std::vector<Stray> strays;
  for (const auto& trace : near.traces[facet.local[k]]) {
    // Seen from the middle of the largest triangle of the trace.
    double total = 0, largest = -1;
    Point<3> middle = Point<3>::Zero();
    for (const auto& x : triangulate<3, 2>(trace.shape)) {
      const double size = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
      total += size;
      if (size <= largest) continue;
      largest = size;
      middle = (x[0] + x[1] + x[2]) / 3;
    }
    std::size_t at = 0;
    while (at < patches.size() && !patch_contains(patches[at], setup_.shapes[index].outward, middle)) ++at;
    const int part = cut.cell_parts[facet.cells[k]] + trace.part;
    if (at == patches.size()) { // so narrow that rounding has put it beside its patch
      strays.push_back({middle, part});
      continue;
    }
    sums[at].area += total;
    if (total <= sums[at].largest) continue;
    sums[at].largest = total;
    sums[at].part = part;
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (!(std::abs(sums[p].area - patches[p].area) <= closure_tolerance * setup_.shapes[index].measure))
      throw CutContradiction{facet.cells[k]};
    if (sums[p].part < 0 && !strays.empty()) {
      Point<3> middle = Point<3>::Zero();
      for (const auto& x : patches[p].outline) middle += x / static_cast<double>(patches[p].outline.size());
      sums[p].part = std::min_element(strays.begin(), strays.end(), [&](const Stray& a, const Stray& b) {
                       return (a.middle - middle).squaredNorm() < (b.middle - middle).squaredNorm();
                     })->part;
    }
    patches[p].parts[k] = sums[p].part;
  }
}

void SpaceCut::connect(int index, const ExactCells<3>& exact, CutMesh<3>& cut) {
  const auto& facet = cut.facets.facets[index];
  const std::size_t begin = cut.connections.size();
  auto* patches = space_.patches(index);
  if (!patches) {
    auto& parts = facet_parts_[index];
    for (int k : {0, 1})
      if (exact.has(facet.cells[k]))
        for (const auto& trace : exact.at(facet.cells[k]).traces[facet.local[k]])
          parts[k] = cut.cell_parts[facet.cells[k]] + trace.part;
    if ((parts[0] < 0) != (parts[1] < 0)) throw CutContradiction{facet.cells[0]};
    if (parts[0] >= 0) add_connection(cut, begin, index, parts, setup_.shapes[index].measure);
    return;
  }
  for (int k : {0, 1})
    if (exact.has(facet.cells[k])) find_exact_parts(index, k, exact, cut, *patches);
  for (const auto& patch : *patches) {
    if (patch.parts[0] < 0 || patch.parts[1] < 0) throw CutContradiction{facet.cells[0]};
    add_connection(cut, begin, index, patch.parts, patch.area);
  }
}

void SpaceCut::add_boundary(int index, CutMesh<3>& cut) {
  const auto* patches = space_.patches(index);
  add_boundary_pieces(cut, index, [&](int part) {
    if (!patches && facet_parts_[index][0] == part)
      append_simplex_quadrature<3, 2>(setup_.boundary_rule, facet_points(cut, index),
                                      cut.boundary_quadrature);
    if (!patches) return;
    for (const auto& patch : *patches)
      if (patch.parts[0] == part &&
          !append_patch_quadrature(patch, setup_.boundary_rule, cut.boundary_quadrature))
        throw CutContradiction{cut.parts[part].cell, "the fluid on a facet of the boundary cannot be filled"};
  });
}

} // namespace undula::geometry
