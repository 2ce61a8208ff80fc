// A failing element as a small text file: the background cell and the solid cells around it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/exact/cut_cell.hpp"

namespace undula::geometry {

/// Input of a cut with one background cell.
template <int dim>
struct CutReproducer {
  SimplexMesh<dim> background;          ///< one cell
  std::vector<SimplexMesh<dim>> solids; ///< as many as in the original cut, with the nearby cells only
  CutOptions options;
};

/// Cuts a mesh down to one cell and the given solid cells.
template <int dim>
CutReproducer<dim> make_reproducer(const SimplexMesh<dim>& background, int cell,
                                   std::span<const SimplexMesh<dim>> solids,
                                   std::span<const SolidCell> solid_cells, const CutOptions& options);

/// Writes hexadecimal floats, so that reading gives the same numbers bit for bit. Throws NumericsError if the
/// file cannot be written.
template <int dim>
void write_reproducer(const CutReproducer<dim>& reproducer, const std::string& path);

/// Throws InputError if the file cannot be read or is not a reproducer of this dimension.
template <int dim>
CutReproducer<dim> read_reproducer(const std::string& path);

/// Reads a reproducer and cuts it again.
template <int dim>
CutMesh<dim> rerun_reproducer(const std::string& path);

} // namespace undula::geometry
