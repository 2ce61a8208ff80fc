// A scene: everything one computation needs, after parsing, in cgs units. Plain data.
// The surface form (keys, units, ranges, defaults) is the declarative table in scene_table.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fom/actuator/actuator.hpp"
#include "fom/problem/blood_damage_law.hpp"
#include "fom/problem/conditions.hpp"
#include "fom/problem/materials.hpp"
#include "fom/problem/stabilisation_weights.hpp"
#include "fom/problem/stepping.hpp"
#include "fom/scene/problem_statement.hpp"

namespace undula::fom {

/// What a scene of a pump is of.
enum class Machine {
  wave_pump,       ///< a membrane between two flanges
  peristaltic_pump ///< a hose on a track, squeezed by rollers
};

enum class Extent { full };

enum class Interface {
  no_slip,
  slip ///< Navier slip of the length of ContactSettings on the skin of the solids
};

/// Unit of length of an imported mesh.
enum class MeshUnit { cm, mm, um, m, inch };

/// Wall friction in a thin gap.
enum class GapFriction {
  poiseuille,  ///< developed laminar profile, 12 viscosity u / height^2
  oscillatory, ///< no weaker than that of two Stokes layers, 2 viscosity u / (height * layer)
};

/// Which weights of the stabilisation a scene starts from, see fom/problem/default_weights.hpp.
enum class DefaultWeights { derived, published };

/// What keeps the reduced pressure stable.
enum class PressureStability {
  projected_stabilisation, ///< the full-order pressure stabilisation, projected
  supremizers,             ///< one velocity mode more per pressure mode, beside it
};

struct OperatingPoint {
  double frequency = 0;    ///< Hz, of the actuator or of the rotor
  double stroke = 0;       ///< cm, amplitude Phi of the holder
  double head = 0;         ///< dyn/cm^2, outlet pressure minus inlet pressure
  double stroke_scale = 1; ///< the holder moves by stroke_scale * stroke
  Drive drive = Drive::stroke;
  double voltage = 0; ///< V, amplitude at the actuator
  /// Values of other keys of the scene, in their units, where a campaign varies them.
  std::map<std::string, double> varied{};
};

struct MeshSizes {
  double gap_elements = 0;  ///< elements across the narrowest clearance between solids and walls
  double channel_size = 0;  ///< cm, in the channels
  double membrane_size = 0; ///< cm, of the membrane's own mesh
  double growth = 0;        ///< increase of element size per unit distance from a gap, -
};

struct TimeSettings : SteppingSettings {
  int steps_per_period = 0;
  int periods = 0;
  double flow_error = 0;   ///< cm^3/s: ends where the mean flow's standard error is below; 0: never
  double ramp_periods = 0; ///< smooth start of stroke and head over this many periods
  double step = 0;         ///< s, of scenes without an actuator (Scene::problem.general)
  double end = 0;          ///< s, of the same
};

/// Radial flow in the gaps above and below the membrane, modelled as an annular plate (Space::thin_gap).
struct ThinGapSettings {
  int cells = 0;                ///< over the membrane's radius, tip to rim
  double film_thickness = 0;    ///< cm, gap height at which contact sets in
  double contact_stiffness = 0; ///< contact pressure per depth below the film thickness, dyn/cm^3
  double throat_recovery = 0;   ///< part of the kinetic energy that returns to pressure where flow slows down
  double exit_recovery = 0;     ///< the same where a gap ends
  double entry_loss = 0;        ///< lost at an entry, in parts of the kinetic energy
  double momentum_factor = 0;   ///< of the velocity profile: 1 plug, 6/5 parabola
  GapFriction friction = GapFriction::poiseuille;
  double newton_tolerance = 0; ///< change of the unknowns at which Newton ends, relative to their scales
};

/// The hose of a peristaltic pump.
struct HoseSettings {
  double bore = 0;            ///< cm, inner diameter
  double wall = 0;            ///< cm, thickness
  double young = 0;           ///< dyn/cm^2; 0: not known, and no force of the hose
  double poisson = 0;         ///< -
  double inlet_length = 0;    ///< cm, from the inlet to the begin of the track
  double outlet_length = 0;   ///< cm, from the end of the track to the outlet
  double throat_recovery = 0; ///< part of the kinetic energy that returns to pressure behind a squeezed place
  double entry_loss = 0;      ///< lost where the flow enters the hose, in parts of the kinetic energy
};

/// Its track and its rollers, evenly spaced on a rotor.
struct RollerSettings {
  int count = 0;
  double radius = 0;       ///< cm
  double track_radius = 0; ///< cm, of the frame's wall
  double track_angle = 0;  ///< rad, over which the track is concentric with the rotor
  double occlusion = 0;    ///< 1 - height of the bore under a roller / bore
  double film = 0;         ///< cm, least height of the bore under a roller
};

/// An input known within bounds: half the width of the interval that holds it with 95 % probability.
struct Tolerance {
  std::string key;      ///< path in the scene table, "operating_point.stroke_mm"
  double tolerance = 0; ///< in the unit of the key
};

/// What `train` makes of the runs.
enum class ModelKind {
  projected, ///< a POD-Galerkin model
  emulator   ///< Gaussian processes of what the runs come to: of any level and any physics
};

/// Box of a training campaign.
struct TrainingPlan {
  ModelKind model = ModelKind::projected;
  double frequency_low = 0, frequency_high = 0; ///< Hz
  double stroke_low = 0, stroke_high = 0;       ///< cm
  double voltage_low = 0, voltage_high = 0;     ///< V, in place of the stroke where a voltage drives
  double head_low = 0, head_high = 0;           ///< dyn/cm^2
  std::vector<std::string> vary;                ///< "section.key=low:high": other keys with a range
  int training_points = 0;                      ///< space-filling, besides the corners of the box
  int held_out_points = 0;
  int snapshots_per_period = 0;
  int sampled_periods = 0;                                            ///< the last ones of each run
  int velocity_modes = 0, pressure_modes = 0, displacement_modes = 0; ///< 0: by energy_tolerance
  double energy_tolerance = 0;                                        ///< 1 - captured energy
  double cubature_error = 0;     ///< part of the forces that cubature may miss
  double periodic_tolerance = 0; ///< change of the velocity over a period at which a run counts as periodic
  PressureStability pressure_stability = PressureStability::projected_stabilisation;
  int ranks_per_run = 1;
};

/// OutputSettings::checkpoint_every: once per period of a pump, and about once a minute.
inline constexpr int automatic_checkpoints = -1;

struct OutputSettings {
  int fields_every = 0;                         ///< steps between field files, 0: none
  int checkpoint_every = automatic_checkpoints; ///< steps between checkpoints, 0: none
  double statistics_from = 0; ///< s, where the window of the statistics begins (Scene::problem.general)
};

struct Scene {
  std::string name;
  std::filesystem::path file;       ///< the scene file itself (absolute), empty if built in code
  std::filesystem::path profile;    ///< pump profile (TOML); relative paths in the scene are relative to it
  std::filesystem::path fluid_mesh; ///< Gmsh meshes instead of a profile; both empty otherwise
  std::vector<std::filesystem::path> solid_meshes; ///< the membrane first
  MeshUnit mesh_unit = MeshUnit::cm;               ///< of the Gmsh meshes
  double clearance_scale = 1; ///< of the clearances between membrane and flanges in the profile
  double rim_gap_scale = 1;   ///< of the gap between the membrane's rim and the housing in the profile
  ProblemStatement problem;   ///< in place of a pump
  Machine machine = Machine::wave_pump;
  Space space = Space::axisymmetric;
  int velocity_order = 1; ///< polynomial degree of the fluid's velocity
  Extent extent = Extent::full;
  Coupling coupling = Coupling::fixed;
  SolidModel solid_model = SolidModel::linear;
  Interface interface = Interface::no_slip;
  FlowModel flow = FlowModel::navier_stokes;
  OpeningCondition inlet = OpeningCondition::total_pressure;
  OpeningCondition outlet = OpeningCondition::total_pressure;
  FluidProperties fluid;
  SolidProperties membrane;
  BloodDamageLaw blood;
  double tip_radius = 0;   ///< cm, of the corners of the membrane's tip; 0: as in the profile
  double rim_radius = 0;   ///< cm, of the corners of its rim; 0: as in the profile
  double clamp_radius = 0; ///< cm; motion of the membrane is imposed for r >= clamp_radius
  HoseSettings hose;
  RollerSettings rollers;
  OperatingPoint operating_point;
  ActuatorSettings actuator; ///< of Drive::voltage
  MeshSizes mesh;
  TimeSettings time;
  ContactSettings contact;
  DefaultWeights default_weights = DefaultWeights::derived;
  StabilisationWeights stabilisation; ///< scales of 0: see weights_in_force
  ThinGapSettings thin_gap;
  TrainingPlan training;
  OutputSettings output;
  std::vector<Tolerance> tolerances;         ///< of inputs stated as { value = ..., tolerance = ... }
  std::map<std::string, std::string> places; ///< path of a key -> where it was stated, "pump.toml:12"
};

} // namespace undula::fom
