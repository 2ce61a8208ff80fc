#include "geometry/cut/exact/cut_cell.hpp"

namespace undula::geometry {

template <int dim>
bool share_facet(const Polytope<dim>& a, const Polytope<dim>& b, const HyperplaneTable<dim>& table) {
  // Pieces of one cell were told apart by a split, so both know the hyperplane between them: what they share
  // lies in it.
  for (const auto& side : a.sides) {
    for (const auto& other : b.sides) {
      if (side.plane != other.plane || side.positive == other.positive) continue;
      const auto facet_a = facet_in(a, side.plane);
      if (!facet_a) return false;
      const auto facet_b = facet_in(b, side.plane);
      return facet_b && intersect<dim>(*facet_a, facet_b->sides, table).has_value();
    }
  }
  return false;
}

template <int dim>
CellCut<dim> cut_cell(const HyperplaneTable<dim>& table, int cell, std::span<const SolidCell> solid_cells) {
  CellCut<dim> cut;
  cut.pieces.push_back(cell_polytope(table, 0, cell));
  for (const auto& solid : solid_cells) {
    const int mesh = mesh_of_solid(solid.solid);
    const auto box = cell_box(table.mesh(mesh), solid.cell);
    const auto sides = table.sides(mesh, solid.cell);
    std::vector<Polytope<dim>> remaining;
    for (auto& piece : cut.pieces) {
      if (!bounding_box(piece).touches(box)) {
        remaining.push_back(std::move(piece));
        continue;
      }
      std::optional<Polytope<dim>> removed;
      for (auto& rest : subtract(piece, sides, table, &removed)) remaining.push_back(std::move(rest));
      if (removed) cut.removed.push_back(std::move(*removed));
    }
    cut.pieces = std::move(remaining);
  }

  // Label propagation over the contact graph.
  const int n = static_cast<int>(cut.pieces.size());
  cut.part_of_piece.assign(n, -1);
  for (int seed = 0; seed < n; ++seed) {
    if (cut.part_of_piece[seed] >= 0) continue;
    std::vector<int> front{seed};
    cut.part_of_piece[seed] = cut.part_count;
    while (!front.empty()) {
      const int piece = front.back();
      front.pop_back();
      for (int other = seed + 1; other < n; ++other) {
        if (cut.part_of_piece[other] >= 0 || !share_facet(cut.pieces[piece], cut.pieces[other], table))
          continue;
        cut.part_of_piece[other] = cut.part_count;
        front.push_back(other);
      }
    }
    ++cut.part_count;
  }
  return cut;
}

#define UNDULA_INSTANTIATE(dim)                                                                            \
  template bool share_facet<dim>(const Polytope<dim>&, const Polytope<dim>&, const HyperplaneTable<dim>&); \
  template CellCut<dim> cut_cell<dim>(const HyperplaneTable<dim>&, int, std::span<const SolidCell>);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
