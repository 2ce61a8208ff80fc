// The squeezed hose with its rollers, to be drawn: a section in the plane of the rotor.
#pragma once

#include <vector>

#include "fom/long_wave/hose_model.hpp"
#include "fom/output/field_writer.hpp"
#include "fom/time/state.hpp"

namespace undula::fom {

/// The lumen with every bore open. The rotor's axis is the origin; of straight ends no more than twice the
/// track's radius is drawn.
FieldMesh<2> lumen_at_rest(const HoseModel& model);

/// The lumen at the time of a state.
FieldMesh<2> lumen(const HoseModel& model, double frequency, const State& state);

/// Both walls with every bore open, and the rollers at time 0.
FieldMesh<2> walls_and_rollers(const HoseModel& model);

/// "velocity" (cm/s, mean over the bore) and "pressure" (dyn/cm^2) on the points of a lumen.
std::vector<NodalField> lumen_fields(const HoseModel& model, const Scene& scene, const State& state);

/// "displacement" (cm) and "velocity" (cm/s; 0, not known) on the points of walls_and_rollers.
std::vector<NodalField> wall_fields(const HoseModel& model, double frequency, const State& state);

} // namespace undula::fom
