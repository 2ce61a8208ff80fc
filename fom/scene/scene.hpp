// A scene: everything one computation needs, after parsing, in cgs units. Plain data.
// The surface form (keys, units, ranges, defaults) is the declarative table in scene_table.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fom/scene/problem_statement.hpp"

namespace undula {

enum class Space { plane, axisymmetric, thin_gap };
enum class Extent { full };
enum class Coupling {
  fixed,     ///< the displacement does not move the fluid domain
  mapped,    ///< one cut at rest; the motion enters through the ALE map
  explicit_, ///< cut anew every step, where the solids are extrapolated to be
  implicit,  ///< fluid domain and displacement of the same instant: cut and solve in turns (thin gap: Newton)
};
/// Where the solids are expected at the end of a step.
enum class Extrapolation {
  first, ///< d + dt v
  second ///< 2 d - d_before, the second order with BDF2's velocities: d + dt (3 v - v_before) / 2
};
enum class SolidModel {
  linear,
  von_karman,             ///< of a plate: stretching by moderate slopes (thin gap)
  saint_venant_kirchhoff, ///< the linear law in the Green-Lagrange strain: large rotations, small strains
  neo_hookean,            ///< compressible; large strains
};
enum class Interface {
  no_slip,
  slip ///< Navier slip of the length of ContactSettings on the skin of the solids
};
enum class FlowModel { stokes, navier_stokes };
enum class TimeScheme { bdf1, bdf2 };
enum class OpeningCondition {
  total_pressure,  ///< sigma n = -p n + rho/2 (u.n) u: energy-neutral, safe against in- and backflow
  static_pressure, ///< the same on inflow only; plain traction on outflow
  traction,        ///< plain traction on both; for verification, blows up on strong inflow
};

/// Velocity that scales the penalty on jumps of the velocity gradient.
enum class VelocityScale {
  reference, ///< StabilisationWeights::reference_velocity, everywhere and always
  local      ///< of the flow across the facet
};

/// Wall friction in a thin gap.
enum class GapFriction {
  poiseuille,  ///< developed laminar profile, 12 viscosity u / height^2
  oscillatory, ///< no weaker than that of two Stokes layers, 2 viscosity u / (height * layer)
};

/// What keeps the reduced pressure stable.
enum class PressureStability {
  projected_stabilisation, ///< the full-order pressure stabilisation, projected
  supremizers,             ///< one velocity mode more per pressure mode, beside it
};

struct FluidProperties {
  double density = 0;   ///< g/cm^3
  double viscosity = 0; ///< g/(cm s)
};

struct SolidProperties {
  double density = 0;      ///< g/cm^3
  double young = 0;        ///< dyn/cm^2
  double poisson = 0;      ///< -
  double damping_time = 0; ///< Kelvin-Voigt: stress = C (strain + damping_time * strain rate), s
  /// Rayleigh: force = mass_damping * mass * velocity + stiffness_damping * (stiffness at rest) * velocity.
  /// For the linear law the second is Kelvin-Voigt itself; for the others it resists rigid rotation, which
  /// Kelvin-Voigt by the rate of the Green-Lagrange strain does not.
  double mass_damping = 0;      ///< 1/s
  double stiffness_damping = 0; ///< s
};

struct OperatingPoint {
  double frequency = 0;    ///< Hz
  double stroke = 0;       ///< cm, amplitude Phi of the holder
  double head = 0;         ///< dyn/cm^2, outlet pressure minus inlet pressure
  double stroke_scale = 1; ///< the holder moves by stroke_scale * stroke
};

struct MeshSizes {
  double gap_elements = 0;  ///< elements across the narrowest clearance between solids and walls
  double channel_size = 0;  ///< cm, in the channels
  double membrane_size = 0; ///< cm, of the membrane's own mesh
  double growth = 0;        ///< increase of element size per unit distance from a gap, -
};

/// Newton's method for solids with a nonlinear law.
struct NewtonSettings {
  double tolerance = 1e-8; ///< of the balance of forces on the solids, relative to their internal forces
  int max_iterations = 20;
};

/// How the fluid's domain follows the solids (couplings other than `fixed`).
struct MotionSettings {
  Extrapolation extrapolation = Extrapolation::second;
  double tolerance = 0;    ///< cm, implicit: largest difference between placed and computed displacement
  int max_iterations = 20; ///< implicit: turns of cut and solve in one step
  int max_halvings = 6;    ///< of the time step, where a step fails or solids would pass a wall
};

/// Contact of the displaced solids with walls: nodes of the skin closer than `film` are pushed off by
/// stiffness * (film / gap - 1).
struct ContactSettings {
  double film = 0;      ///< cm, thickness of the film that is kept; 0: no contact law
  double stiffness = 0; ///< dyn/cm^2
  double slip = 0;      ///< Navier slip length on the solids' skin, cm (Interface::slip)
};

struct TimeSettings {
  TimeScheme scheme = TimeScheme::bdf2;
  int steps_per_period = 0;
  int periods = 0;
  double ramp_periods = 0; ///< smooth start of stroke and head over this many periods
  double step = 0;         ///< s, of scenes without an actuator (Scene::problem.stated)
  double end = 0;          ///< s, of the same
  int factor_every = 1;    ///< steps that share one factorisation; the rest is left to GMRES
  NewtonSettings newton;
  MotionSettings motion;
};

/// Weights of the stabilisation. They do not depend on the solution (the reduced model inherits them
/// exactly): phi = viscosity + density * reference_velocity * h + density * h^2 / reference_time.
struct StabilisationWeights {
  double velocity_jump = 0;  ///< CIP on [grad u], times density * velocity * h^2
  double pressure_jump = 0;  ///< CIP on [grad p], times h^3 / phi
  double divergence = 0;     ///< CIP on [div u], times phi * h
  double ghost_viscous = 0;  ///< ghost penalty on [grad u] of cut parts, times viscosity * h
  double ghost_inertial = 0; ///< ghost penalty on [grad u] of cut parts, times density * h^3 / reference_time
  double ghost_pressure = 0; ///< ghost penalty on [grad p] of cut parts, times h^3 / phi
  double nitsche_viscous = 0;                              ///< penalty viscosity / h
  double nitsche_normal = 0;                               ///< penalty phi / h on the normal component
  double reference_velocity = 0;                           ///< cm/s
  double reference_time = 0;                               ///< s
  VelocityScale velocity_scale = VelocityScale::reference; ///< of velocity_jump
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

/// An input known within bounds: half the width of the interval that holds it with 95 % probability.
struct Tolerance {
  std::string key;      ///< path in the scene table, "operating_point.stroke_mm"
  double tolerance = 0; ///< in the unit of the key
};

/// Box of a training campaign.
struct TrainingPlan {
  double frequency_low = 0, frequency_high = 0; ///< Hz
  double stroke_low = 0, stroke_high = 0;       ///< cm
  double head_low = 0, head_high = 0;           ///< dyn/cm^2
  int training_points = 0;                      ///< space-filling, besides the corners of the box
  int held_out_points = 0;
  int snapshots_per_period = 0;
  int sampled_periods = 0;                                            ///< the last ones of each run
  int velocity_modes = 0, pressure_modes = 0, displacement_modes = 0; ///< 0: by energy_tolerance
  double energy_tolerance = 0;                                        ///< 1 - captured energy
  double periodic_tolerance = 0; ///< change of the velocity over a period at which a run counts as periodic
  PressureStability pressure_stability = PressureStability::projected_stabilisation;
  int ranks_per_run = 1;
};

struct OutputSettings {
  int fields_every = 0;       ///< steps between field files, 0: none
  int checkpoint_every = 0;   ///< steps between checkpoints, 0: none
  double statistics_from = 0; ///< s, where the window of the statistics begins (Scene::problem.stated)
};

struct Scene {
  std::string name;
  std::filesystem::path file;       ///< the scene file itself (absolute), empty if built in code
  std::filesystem::path profile;    ///< pump profile (TOML); relative paths in the scene are relative to it
  std::filesystem::path fluid_mesh; ///< Gmsh meshes instead of a profile; both empty otherwise
  std::vector<std::filesystem::path> solid_meshes;
  double clearance_scale = 1; ///< of the clearances between membrane and flanges in the profile
  double rim_gap_scale = 1;   ///< of the gap between the membrane's rim and the housing in the profile
  ProblemStatement problem;   ///< in place of a pump
  Space space = Space::axisymmetric;
  Extent extent = Extent::full;
  Coupling coupling = Coupling::fixed;
  SolidModel solid_model = SolidModel::linear;
  Interface interface = Interface::no_slip;
  FlowModel flow = FlowModel::navier_stokes;
  OpeningCondition inlet = OpeningCondition::total_pressure;
  OpeningCondition outlet = OpeningCondition::total_pressure;
  FluidProperties fluid;
  SolidProperties membrane;
  double clamp_radius = 0; ///< cm; motion of the membrane is imposed for r >= clamp_radius
  OperatingPoint operating_point;
  MeshSizes mesh;
  TimeSettings time;
  ContactSettings contact;
  StabilisationWeights stabilisation;
  ThinGapSettings thin_gap;
  TrainingPlan training;
  OutputSettings output;
  std::vector<Tolerance> tolerances; ///< of inputs stated as { value = ..., tolerance = ... }
};

} // namespace undula
