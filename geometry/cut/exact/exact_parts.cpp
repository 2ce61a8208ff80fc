#include "geometry/cut/exact/exact_parts.hpp"

#include <numeric>
#include <utility>

#include "geometry/cut/cut_records.hpp"

namespace undula::geometry {
namespace {

template <int dim>
void add_volume(const CellCut<dim>& shape, int part, const ReferenceRule<dim>& rule, CutMesh<dim>& cut) {
  auto& record = cut.parts.back();
  record.quadrature_begin = static_cast<int>(cut.volume_quadrature.weights.size());
  record.simplex_begin = static_cast<int>(cut.simplices.size());
  for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
    if (shape.part_of_piece[i] != part) continue;
    for (const auto& simplex : triangulate<dim, dim>(shape.pieces[i])) {
      append_simplex_quadrature<dim, dim>(rule, simplex, cut.volume_quadrature);
      cut.simplices.push_back(simplex);
    }
  }
  close_part(cut, record);
}

template <int dim>
std::pair<int, int> add_facet_quadrature(const std::vector<Polytope<dim>>& shapes,
                                         const ReferenceRule<dim - 1>& rule, QuadratureSet<dim>& set) {
  const int begin = static_cast<int>(set.weights.size());
  for (const auto& shape : shapes)
    for (const auto& simplex : triangulate<dim, dim - 1>(shape))
      append_simplex_quadrature<dim, dim - 1>(rule, simplex, set);
  return {begin, static_cast<int>(set.weights.size())};
}

template <int dim>
void add_interface(const Polytope<dim>& piece, int part, const HyperplaneTable<dim>& table,
                   const ReferenceRule<dim - 1>& rule, CutMesh<dim>& cut) {
  for (const auto& side : piece.sides) {
    const auto [mesh, index] = table.origin(side.plane);
    if (mesh == 0 || side.positive) continue; // hyperplanes point into the first cell of their facet
    const auto& facet = table.facets(mesh).facets[index];
    if (facet.cells[1] >= 0) continue;
    auto contact = facet_in(piece, side.plane);
    if (!contact) continue;
    std::vector<HalfSpace> extent;
    for (const auto& solid_side : table.sides(mesh, facet.cells[0]))
      if (solid_side.plane != side.plane) extent.push_back(solid_side);
    contact = intersect<dim>(std::move(*contact), extent, table);
    if (!contact) continue;
    InterfacePiece<dim> record{part, mesh - 1, facet.cells[0], {}, 0, 0};
    // The barycentric coordinate of the opposite vertex rises into the solid.
    record.normal = barycentric_gradients(table.mesh(mesh), facet.cells[0]).col(facet.local[0]).normalized();
    std::tie(record.quadrature_begin, record.quadrature_end) =
        add_facet_quadrature<dim>({*contact}, rule, cut.interface_quadrature);
    cut.interface.push_back(record);
  }
}

template <int dim>
double measure_of(const Polytope<dim>& shape, const ReferenceRule<dim - 1>& rule) {
  QuadratureSet<dim> set;
  add_facet_quadrature<dim>({shape}, rule, set);
  return std::accumulate(set.weights.begin(), set.weights.end(), 0.0);
}

// Traces of a cell on its facet; null for a cell whose one part covers the facet whole.
template <int dim>
const std::vector<FacetTrace<dim>>* traces(const CutMesh<dim>& cut, const ExactCells<dim>& exact, int cell,
                                           int local) {
  const bool whole =
      cut.cell_parts[cell + 1] - cut.cell_parts[cell] == 1 && !cut.parts[cut.cell_parts[cell]].cut;
  return whole ? nullptr : &exact.at(cell).traces[local];
}

template <int dim>
std::vector<Polytope<dim>> uncovered(std::vector<Polytope<dim>> shapes, const ExactCell<dim>& near,
                                     const HyperplaneTable<dim>& table) {
  for (const auto& solid : near.solid_cells) {
    const auto sides = table.sides(mesh_of_solid(solid.solid), solid.cell);
    std::vector<Polytope<dim>> rest;
    for (const auto& shape : shapes)
      for (auto& piece : subtract(shape, sides, table)) rest.push_back(std::move(piece));
    shapes = std::move(rest);
  }
  return shapes;
}

} // namespace

template <int dim>
void add_exact_parts(const ExactCell<dim>& near, const HyperplaneTable<dim>& table,
                     const typename BackgroundCutter<dim>::Setup& setup, CutMesh<dim>& cut) {
  const auto& shape = near.shape;
  const int first = static_cast<int>(cut.parts.size());
  const bool is_cut = !shape.removed.empty();
  for (int part = 0; part < shape.part_count; ++part) {
    if (!is_cut) {
      add_whole(cut, near.cell);
      continue;
    }
    cut.parts.push_back({near.cell, true});
    add_volume(shape, part, setup.volume_rule, cut);
  }
  for (std::size_t i = 0; i < shape.pieces.size(); ++i)
    add_interface(shape.pieces[i], first + shape.part_of_piece[i], table, setup.interface_rule, cut);
}

template <int dim>
void connect_exact(int index, ExactCells<dim>& exact, const typename BackgroundCutter<dim>::Setup& setup,
                   CutMesh<dim>& cut) {
  const auto& facet = cut.facets.facets[index];
  const std::vector<FacetTrace<dim>>* sides[2] = {traces(cut, exact, facet.cells[0], facet.local[0]),
                                                  traces(cut, exact, facet.cells[1], facet.local[1])};
  const int first_part[2] = {cut.cell_parts[facet.cells[0]], cut.cell_parts[facet.cells[1]]};
  const std::size_t begin = cut.connections.size();
  const auto add = [&](int part_0, int part_1, double measure) {
    add_connection(cut, begin, index, {part_0, part_1}, measure);
  };
  if (!sides[0] && !sides[1]) {
    add(first_part[0], first_part[1], setup.shapes[index].measure);
  } else if (!sides[0]) {
    for (const auto& trace : *sides[1])
      add(first_part[0], first_part[1] + trace.part, measure_of<dim>(trace.shape, setup.boundary_rule));
  } else if (!sides[1]) {
    for (const auto& trace : *sides[0])
      add(first_part[0] + trace.part, first_part[1], measure_of<dim>(trace.shape, setup.boundary_rule));
  } else {
    for (const auto& a : *sides[0])
      for (const auto& b : *sides[1])
        if (const auto shared = intersect<dim>(a.shape, b.shape.sides, exact.table()))
          add(first_part[0] + a.part, first_part[1] + b.part, measure_of<dim>(*shared, setup.boundary_rule));
  }
}

template <int dim>
void add_exact_boundary(int index, ExactCells<dim>& exact, const typename BackgroundCutter<dim>::Setup& setup,
                        CutMesh<dim>& cut) {
  const auto& facet = cut.facets.facets[index];
  const int cell = facet.cells[0];
  add_boundary_pieces(cut, index, [&](int part) {
    if (!exact.has(cell)) {
      append_simplex_quadrature<dim, dim - 1>(setup.boundary_rule, facet_points(cut, index),
                                              cut.boundary_quadrature);
      return;
    }
    const auto& near = exact.at(cell);
    std::vector<Polytope<dim>> wet;
    for (const auto& trace : near.traces[facet.local[0]])
      if (cut.cell_parts[cell] + trace.part == part) wet.push_back(trace.shape);
    add_facet_quadrature<dim>(uncovered(std::move(wet), near, exact.table()), setup.boundary_rule,
                              cut.boundary_quadrature);
  });
}

#define UNDULA_INSTANTIATE(dim)                                                                     \
  template void add_exact_parts<dim>(const ExactCell<dim>&, const HyperplaneTable<dim>&,            \
                                     const BackgroundCutter<dim>::Setup&, CutMesh<dim>&);           \
  template void connect_exact<dim>(int, ExactCells<dim>&, const BackgroundCutter<dim>::Setup&,      \
                                   CutMesh<dim>&);                                                  \
  template void add_exact_boundary<dim>(int, ExactCells<dim>&, const BackgroundCutter<dim>::Setup&, \
                                        CutMesh<dim>&);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
