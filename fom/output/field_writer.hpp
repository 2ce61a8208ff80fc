// Fields over time for ParaView: XDMF 3 beside HDF5.
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "fom/fom.hpp"
#include "fom/output/xdmf.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// What is drawn: for the fluid the sub-triangulated parts of the cut mesh, points repeated where a field
/// jumps.
template <int dim>
struct FieldMesh {
  std::vector<Point<dim>> points; ///< cm; in axisymmetric space (r, z), shown as x = r, y = z
  std::vector<std::array<int, dim + 1>> cells;
};

/// Nodal values on the points of a FieldMesh.
struct NodalField {
  std::string name;           ///< e.g. "velocity"; letters, digits and _
  std::string unit;           ///< e.g. "cm/s"
  int components = 1;         ///< 1 or dim
  std::vector<double> values; ///< [point][component]
};

/// Writes one series: <name>.xdmf, to be opened in ParaView, <name>_mesh.h5 and one <name>_<step>.h5 per
/// written step. Every file is replaced in one step and the XDMF comes last, so that a kill at any moment
/// leaves a series that can be read; the XDMF may then lack the last second. Files reach the disk by sync().
/// For one rank. Two-dimensional points and vectors get a third component
/// 0.
template <int dim>
class FieldWriter {
public:
  /// Starts an empty series in `folder` (created); removes the files of an earlier one of the same name.
  static FieldWriter start(const std::filesystem::path& folder, const std::string& name,
                           const FieldMesh<dim>& mesh, const std::map<std::string, std::string>& provenance);

  /// Goes on after a checkpoint: keeps what was written up to `last_step` and drops the rest, unreadable
  /// files included. Throws InputError if the files kept have another number of points than `mesh`.
  static FieldWriter go_on(const std::filesystem::path& folder, const std::string& name,
                           const FieldMesh<dim>& mesh, const std::map<std::string, std::string>& provenance,
                           int last_step);

  /// Adds one time, in s, on the mesh of the series or on one of its own (`mesh`). Throws InputError for
  /// fields that do not fit the mesh, a name given twice or a step that is not later than the last one.
  void write(int step, double time, std::span<const NodalField> fields, const FieldMesh<dim>* mesh = nullptr);

  /// Completes the index and brings all that was written to the disk: before a checkpoint that relies on it.
  void sync();

private:
  FieldWriter(std::filesystem::path folder, const std::string& name, const FieldMesh<dim>& mesh,
              const std::map<std::string, std::string>& provenance);
  std::map<int, std::filesystem::path> step_files() const;
  XdmfStep read_step(const std::filesystem::path& file) const;
  void write_mesh(const FieldMesh<dim>& mesh) const;
  void write_index();

  std::filesystem::path folder_;
  std::map<std::string, std::string> provenance_;
  XdmfSeries series_;
  std::vector<std::filesystem::path> unsynced_;           ///< written since the last sync()
  std::chrono::steady_clock::time_point indexed_at_ = {}; ///< when the index was written
  std::size_t indexed_steps_ = 0;
};

} // namespace undula::fom
