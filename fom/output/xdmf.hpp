// The index of a field series in XDMF 3 (xdmf.org), as ParaView reads it.
#pragma once

#include <string>
#include <vector>

namespace undula::fom {

struct XdmfField {
  std::string name, unit;
  bool vector = false; ///< three components, else one
};

/// One time: its values are in the HDF5 file `file` under /fields/<name>.
struct XdmfStep {
  int step = 0;
  double time = 0;  ///< s
  std::string file; ///< relative to the index
  std::vector<XdmfField> fields;
  /// Extents of a mesh of its own, in `file` as the series' mesh is in its; 0: the mesh of the series.
  std::size_t points = 0, cells = 0;
};

/// A mesh for all steps that have none of their own, in the HDF5 file `mesh_file` as /points (n x 3) and
/// /cells (m x (dim + 1)).
struct XdmfSeries {
  std::string name;
  std::string mesh_file; ///< relative to the index
  int dim = 0;           ///< of the cells: 2 triangles, 3 tetrahedra
  std::size_t points = 0, cells = 0;
  std::vector<XdmfStep> steps;
};

/// The whole XML document: a temporal collection of uniform grids.
std::string xdmf_text(const XdmfSeries& series);

} // namespace undula::fom
