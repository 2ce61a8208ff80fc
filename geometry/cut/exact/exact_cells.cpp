#include "geometry/cut/exact/exact_cells.hpp"

#include <utility>

namespace undula::geometry {

template <int dim>
ExactCells<dim>::ExactCells(const Setup& setup, std::span<const SimplexMesh<dim>> solids)
    : setup_(setup), solids_(solids), index_(setup.mesh.cells.size(), -1) {}

template <int dim>
std::vector<SolidCell> ExactCells<dim>::near_solid_cells(int cell) {
  if (!grid_) {
    std::vector<Box<dim>> boxes;
    for (int s = 0; s < static_cast<int>(solids_.size()); ++s) {
      for (int c = 0; c < static_cast<int>(solids_[s].cells.size()); ++c) {
        all_solid_cells_.push_back({s, c});
        boxes.push_back(cell_box(solids_[s], c));
      }
    }
    grid_.emplace(std::move(boxes));
  }
  std::vector<SolidCell> near;
  for (const int i : grid_->touching(cell_box(setup_.mesh, cell))) near.push_back(all_solid_cells_[i]);
  return near;
}

template <int dim>
const HyperplaneTable<dim>& ExactCells<dim>::table() {
  if (!table_) {
    std::vector<const SimplexMesh<dim>*> meshes{&setup_.mesh};
    std::vector<const FacetTable<dim>*> facets{&setup_.facets};
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      meshes.push_back(&solids_[s]);
      facets.push_back(&setup_.solid_facets[s]);
    }
    table_.emplace(std::move(meshes), std::move(facets));
  }
  return *table_;
}

template <int dim>
void ExactCells<dim>::cut(int cell) {
  auto near = near_solid_cells(cell);
  auto shape = cut_cell(table(), cell, std::span<const SolidCell>(near));
  index_[cell] = static_cast<int>(cells_.size());
  auto& record = cells_.emplace_back(ExactCell<dim>{cell, std::move(near), std::move(shape), {}});
  for (std::size_t i = 0; i < record.shape.pieces.size(); ++i)
    for (int v = 0; v <= dim; ++v)
      if (auto trace = facet_in(record.shape.pieces[i], table().plane(0, setup_.facets.cell_facets[cell][v])))
        record.traces[v].push_back({record.shape.part_of_piece[i], std::move(*trace)});
}

template class ExactCells<2>;
template class ExactCells<3>;

} // namespace undula::geometry
