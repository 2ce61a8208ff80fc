// What of a computed state is written and drawn, whatever level computed it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fom/output/field_writer.hpp"
#include "fom/output/step_table.hpp"
#include "geometry/mesh/box_grid.hpp"

namespace undula::fom {

/// Fields of a state on the points of a picture.
using FieldsOfState = std::function<std::vector<NodalField>(const State&)>;

/// The fluid's picture where it is in a state.
using PictureOfState = std::function<FieldMesh<2>(const State&)>;

/// Probes, pictures and fields of one level. The functions refer to the level, which has to outlive them.
struct LevelView {
  MembraneProbes probes;                         ///< none but for pumps
  RowLayout rows;                                ///< of time_series.csv
  FieldMesh<2> fluid;                            ///< at rest
  FieldMesh<2> solids;                           ///< at rest
  std::vector<std::array<Point<2>, 2>> outlines; ///< cm, edges that bound the fluid at rest
  std::vector<std::array<Point<2>, 2>> walls;    ///< cm, those of Observation::wall_shear; may be none
  Box<2> membrane_box;                           ///< cm, around the first solid at rest
  PictureOfState moved_fluid; ///< empty where the fluid's domain does not move: then it is `fluid`
  FieldsOfState fluid_fields; ///< on `moved_fluid` or `fluid`: "velocity" (cm/s), "pressure" (dyn/cm^2), ...
  FieldsOfState solid_fields; ///< on `solids`: "displacement" (cm), "velocity" (cm/s)
};

/// The field with this name. Throws InputError naming the fields there are.
const NodalField& field_named(const std::vector<NodalField>& fields, const std::string& name);

/// Pairs of points that are an edge of one triangle only: the boundary of a picture.
std::vector<std::array<int, 2>> boundary_edges(const FieldMesh<2>& mesh);

} // namespace undula::fom
