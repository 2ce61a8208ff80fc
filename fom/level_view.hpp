// What of a computed state is written and drawn, whatever level computed it.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fom/io/field_writer.hpp"
#include "fom/observables.hpp"

namespace undula {

/// Fields of a state on the points of a picture.
using FieldsOfState = std::function<std::vector<NodalField>(const State&)>;

/// Probes, pictures and fields of one level. The functions refer to the level, which has to outlive them.
struct LevelView {
  MembraneProbes probes;
  FieldMesh<2> fluid;                            ///< at rest
  FieldMesh<2> solids;                           ///< at rest
  std::vector<std::array<Point<2>, 2>> outlines; ///< cm, edges that bound the fluid at rest
  std::array<Point<2>, 2> membrane_box;          ///< cm, lowest and highest corner of the membrane at rest
  FieldsOfState fluid_fields; ///< on `fluid`: "velocity" (cm/s), "pressure" (dyn/cm^2), ...
  FieldsOfState solid_fields; ///< on `solids`: "displacement" (cm), "velocity" (cm/s)
};

/// The field with this name. Throws InputError naming the fields there are.
const NodalField& field_named(const std::vector<NodalField>& fields, const std::string& name);

/// Pairs of points that are an edge of one triangle only: the boundary of a picture.
std::vector<std::array<int, 2>> boundary_edges(const FieldMesh<2>& mesh);

} // namespace undula
