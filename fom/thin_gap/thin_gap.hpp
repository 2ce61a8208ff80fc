// The thin-gap level: radial flow in the gaps above and below the membrane, an annular plate between them,
// and the channels that join the gaps to the inlet and the outlet.
#pragma once

#include "fom/output/field_writer.hpp"
#include "fom/output/observables.hpp"
#include "fom/scene/scene.hpp"
#include "fom/thin_gap/band_matrix.hpp"
#include "fom/thin_gap/layout.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// What one thin-gap computation needs apart from its operating point: the geometry as coefficients.
/// Operating points of a curve share it.
struct ThinGapModel {
  ThinGapLayout layout;
};

/// From the scene's profile. Phases "mesh" (channels), "coefficients". Throws InputError for a profile whose
/// parts do not form two gaps, two channels and a rim gap.
ThinGapModel prepare_thin_gap(const Scene& scene, PhaseTimer& timer);

/// Number of unknowns of one time step: rows of State::x.
int unknowns(const ThinGapModel& model);

/// Rest. State::x: pressures, flows and velocities of the plate; State::d: displacements of the plate.
State initial_state(const ThinGapModel& model);

/// Steps at one operating point, which may differ from that of the scene the model was prepared from. Model
/// and timer have to outlive it. Phases "assemble", "factor", "solve", "observe".
class ThinGapStepper {
public:
  ThinGapStepper(const ThinGapModel& model, const Scene& scene, PhaseTimer& timer);

  /// One time step, in parts where Newton's method fails at the whole one. Throws NumericsError, leaving
  /// `state` at the last good step.
  Observation advance(State& state);

private:
  const ThinGapModel& model_;
  Scene scene_;
  PhaseTimer& timer_;
  BandMatrix matrix_;
};

/// Axial displacement of the plate from State::d at `count` radii from the tip to the rim.
MembraneProbes membrane_probes(const ThinGapModel& model, int count);

/// Strips of triangles that fill the two gaps at rest, and the section of the plate.
FieldMesh<2> fluid_picture(const ThinGapModel& model);
FieldMesh<2> solid_picture(const ThinGapModel& model);

/// "velocity" (cm/s, radial), "pressure" (dyn/cm^2), "height" (cm) on the points of fluid_picture.
std::vector<NodalField> fluid_fields(const ThinGapModel& model, const State& state);

/// "displacement" (cm), "velocity" (cm/s) on the points of solid_picture.
std::vector<NodalField> solid_fields(const ThinGapModel& model, const State& state);

} // namespace undula::fom
