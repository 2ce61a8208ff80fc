#include "fom/scene/scene_table.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <type_traits>

#include "fom/problem/default_weights.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double cm_per_mm = units::cm_per_mm;
constexpr double mmHg = units::dyn_per_cm2_per_mmHg;
constexpr bool shapes_state = true;
constexpr bool leaves_state = false;

AllowedRange from_to(double low, double high) { return {low, high, false, false}; }
AllowedRange above_to(double low, double high) { return {low, high, true, false}; }
AllowedRange between(double low, double high) { return {low, high, true, true}; }

template <auto field>
ChoiceKey choice(std::vector<std::pair<std::string, int>> available, std::vector<std::string> planned,
                 std::string fallback) {
  using Enum = std::remove_reference_t<decltype(field(std::declval<Scene&>()))>;
  return {[](Scene& scene) { return static_cast<int>(field(scene)); },
          [](Scene& scene, int value) { field(scene) = static_cast<Enum>(value); }, std::move(available),
          std::move(planned), std::move(fallback)};
}

template <typename Enum>
std::pair<std::string, int> name(const char* text, Enum value) {
  return {text, static_cast<int>(value)};
}

// A function that returns a reference to a member of a scene.
#define FIELD(member) [](Scene& scene) -> decltype(auto) { return (scene.member); }

std::vector<SceneKey> geometry_keys() {
  return {
      {"geometry.profile", "", "pump profile (TOML); a relative path starts at the scene file", shapes_state,
       FileKey{FIELD(profile)}},
      {"geometry.clearance_scale", "",
       "factor on the clearances between membrane and flanges of the profile, by moving the flanges",
       shapes_state, RealKey{FIELD(clearance_scale), 1, from_to(0.1, 10), 1.0}},
      {"geometry.rim_gap_scale", "",
       "factor on the gap between the membrane's rim and the housing of the profile, by moving the rim",
       shapes_state, RealKey{FIELD(rim_gap_scale), 1, from_to(0.1, 10), 1.0}},
      {"geometry.fluid_mesh", "",
       "Gmsh mesh of the fluid background, in place of a profile; the solids are not cut out of it; its "
       "boundaries are named `inlet`, `outlet` and `axis` (r = 0), all others are walls",
       shapes_state, FileKey{FIELD(fluid_mesh)}},
      {"geometry.solid_meshes", "",
       "Gmsh meshes of the solids, with `fluid_mesh`: first the membrane, then what moves with its holder",
       shapes_state, FileListKey{FIELD(solid_meshes)}},
      {"geometry.mesh_unit", "", "unit of length in the Gmsh meshes, all of them", shapes_state,
       choice<FIELD(mesh_unit)>({name("cm", MeshUnit::cm), name("mm", MeshUnit::mm), name("um", MeshUnit::um),
                                 name("m", MeshUnit::m), name("inch", MeshUnit::inch)},
                                {}, "cm")},
  };
}

std::vector<SceneKey> model_keys() {
  return {
      {"name", "", "label of the computation, used in file names and plots", leaves_state,
       TextKey{FIELD(name)}},
      // Told apart by its other keys: old records stay valid.
      {"model.machine", "", "what the pump is; `peristaltic-pump`: a hose on a track, squeezed by rollers",
       leaves_state,
       choice<FIELD(machine)>(
           {name("wave-pump", Machine::wave_pump), name("peristaltic-pump", Machine::peristaltic_pump)}, {},
           "wave-pump"),
       Scope::pump},
      {"model.space", "",
       "space the equations are solved in; `thin-gap`: radial flow in the two gaps along an annular plate; "
       "`long-wave`: flow along a hose that rollers squeeze",
       shapes_state,
       choice<FIELD(space)>({name("axisymmetric", Space::axisymmetric), name("plane", Space::plane),
                             name("thin-gap", Space::thin_gap), name("long-wave", Space::long_wave)},
                            {"3d"}, "axisymmetric")},
      {"space.order", "",
       "polynomial degree of the fluid's velocity; 2: quadratic, with a linear pressure, for the couplings "
       "`fixed` and `mapped`",
       shapes_state, IntegerKey{FIELD(velocity_order), 1, 2, 1}},
      {"model.extent", "", "part of the pump that is computed", shapes_state,
       choice<FIELD(extent)>({name("full", Extent::full)}, {"head", "lower"}, "full")},
      {"model.coupling", "",
       "how the fluid's domain follows the solids; `fixed`: not at all, one cut at rest; `mapped`: one cut "
       "at "
       "rest, the motion enters through a map of the domain; `explicit`: cut anew every step, where the "
       "solids "
       "are extrapolated to be; `implicit`: cut and solve in turns until both agree (thin gap: always, by "
       "Newton)",
       shapes_state,
       choice<FIELD(coupling)>({name("fixed", Coupling::fixed), name("mapped", Coupling::mapped),
                                name("explicit", Coupling::explicit_), name("implicit", Coupling::implicit)},
                               {}, "fixed")},
      {"model.solid", "",
       "constitutive law of the membrane; `saint-venant-kirchhoff`: large rotations, small strains; "
       "`neo-hookean`: large strains, mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2; `von-karman`: plate "
       "stretched "
       "by its slopes (thin gap only)",
       shapes_state,
       choice<FIELD(solid_model)>(
           {name("linear", SolidModel::linear),
            name("saint-venant-kirchhoff", SolidModel::saint_venant_kirchhoff),
            name("neo-hookean", SolidModel::neo_hookean), name("von-karman", SolidModel::von_karman)},
           {}, "linear")},
      {"model.interface", "",
       "condition between fluid and solid; `slip`: along the skin the fluid slips by Navier's law, with the "
       "length `contact.slip_length_mm`",
       shapes_state,
       choice<FIELD(interface)>({name("no-slip", Interface::no_slip), name("slip", Interface::slip)}, {},
                                "no-slip")},
      {"model.flow", "", "flow equations; `stokes` leaves convection out", shapes_state,
       choice<FIELD(flow)>(
           {name("stokes", FlowModel::stokes), name("navier-stokes", FlowModel::navier_stokes)},
           {"rng-k-epsilon"}, "navier-stokes")},
      {"model.inlet", "",
       "what the inlet prescribes; `static-pressure` leaves the dynamic term out on outflow", shapes_state,
       choice<FIELD(inlet)>({name("total-pressure", OpeningCondition::total_pressure),
                             name("static-pressure", OpeningCondition::static_pressure)},
                            {}, "total-pressure")},
      {"model.outlet", "", "what the outlet prescribes, as for the inlet", shapes_state,
       choice<FIELD(outlet)>({name("total-pressure", OpeningCondition::total_pressure),
                              name("static-pressure", OpeningCondition::static_pressure)},
                             {}, "total-pressure")},
  };
}

std::vector<SceneKey> fluid_keys() {
  return {
      {"fluid.density_g_per_cm3", "g_per_cm3", "density of the fluid", shapes_state,
       RealKey{FIELD(fluid.density), 1, above_to(0, 100), {}}},
      {"fluid.viscosity_poise", "poise", "dynamic viscosity of the fluid, 1 poise = 0.1 Pa s", shapes_state,
       RealKey{FIELD(fluid.viscosity), 1, above_to(0, 1e4), {}}},
  };
}

std::vector<SceneKey> pump_keys() {
  return {
      {"membrane.density_g_per_cm3", "g_per_cm3", "density of the membrane", shapes_state,
       RealKey{FIELD(membrane.density), 1, above_to(0, 100), {}}},
      {"membrane.young_dyn_per_cm2", "dyn_per_cm2", "Young's modulus, 1 dyn/cm^2 = 0.1 Pa", shapes_state,
       RealKey{FIELD(membrane.young), 1, above_to(0, 1e14), {}}},
      {"membrane.poisson", "", "Poisson's ratio", shapes_state,
       RealKey{FIELD(membrane.poisson), 1, between(-1, 0.5), {}}},
      {"membrane.damping_time_s", "s",
       "Kelvin-Voigt damping: stress = C (strain + damping time * strain rate); loss factor 2 pi f * damping "
       "time",
       shapes_state, RealKey{FIELD(membrane.damping_time), 1, from_to(0, 1), {}}},
      {"membrane.mass_damping_per_s", "per_s", "Rayleigh damping: force = this * mass * velocity",
       shapes_state, RealKey{FIELD(membrane.mass_damping), 1, from_to(0, 1e6), 0.0}},
      {"membrane.stiffness_damping_s", "s",
       "Rayleigh damping: force = this * (stiffness at rest) * velocity; for the linear solid the same as "
       "`damping_time_s`, so that one of the two has to be 0",
       shapes_state, RealKey{FIELD(membrane.stiffness_damping), 1, from_to(0, 1), 0.0}},
      {"membrane.tip_radius_mm", "mm",
       "radius of the corners of the membrane's tip; 0: as in the profile, where `membrane.tip_radius` is 0 "
       "(sharp) if it is not stated",
       shapes_state, RealKey{FIELD(tip_radius), cm_per_mm, from_to(0, 1e4), 0.0}},
      {"membrane.rim_radius_mm", "mm", "the same of the corners of its rim", shapes_state,
       RealKey{FIELD(rim_radius), cm_per_mm, from_to(0, 1e4), 0.0}},
      {"membrane.clamp_radius_mm", "mm",
       "the motion of the membrane is imposed from this radius outwards; 0: the radius in the profile",
       shapes_state, RealKey{FIELD(clamp_radius), cm_per_mm, from_to(0, 1e4), 0.0}},
      {"operating_point.frequency_Hz", "Hz",
       "frequency f of the actuator; of a peristaltic pump the turns of its rotor per second", shapes_state,
       RealKey{FIELD(operating_point.frequency), 1, above_to(0, 1e5), {}}, Scope::pump},
      {"operating_point.drive", "",
       "what the holder is driven with; `stroke`: its motion is imposed; `voltage`: the force of the "
       "[actuator], the motion is an answer",
       shapes_state,
       choice<FIELD(operating_point.drive)>({name("stroke", Drive::stroke), name("voltage", Drive::voltage)},
                                            {}, "stroke")},
      {"operating_point.stroke_mm", "mm",
       "amplitude of the imposed motion, stroke * sin(2 pi f t); not needed with a voltage", shapes_state,
       RealKey{FIELD(operating_point.stroke), cm_per_mm, from_to(0, 100), {}}},
      {"operating_point.voltage_V", "V", "amplitude of the voltage, voltage * sin(2 pi f t)", shapes_state,
       RealKey{FIELD(operating_point.voltage), 1, from_to(0, 1e5), 0.0}},
      {"operating_point.stroke_scale", "",
       "factor on the stroke: what the holder does of what the actuator is said to do", shapes_state,
       RealKey{FIELD(operating_point.stroke_scale), 1, from_to(0, 10), 1.0}},
      {"operating_point.head_mmHg", "mmHg", "outlet pressure minus inlet pressure", shapes_state,
       RealKey{FIELD(operating_point.head), mmHg, from_to(-1e4, 1e4), {}}, Scope::pump},
  };
}

std::vector<SceneKey> hose_keys() {
  constexpr double radians = std::numbers::pi / 180;
  return {
      {"hose.bore_mm", "mm", "inner diameter of the hose", shapes_state,
       RealKey{FIELD(hose.bore), cm_per_mm, above_to(0, 1e3), {}}},
      {"hose.wall_mm", "mm", "thickness of its wall", shapes_state,
       RealKey{FIELD(hose.wall), cm_per_mm, above_to(0, 1e3), {}}},
      {"hose.young_dyn_per_cm2", "dyn_per_cm2",
       "Young's modulus of the wall, for the force on the rollers; 0: not known", shapes_state,
       RealKey{FIELD(hose.young), 1, from_to(0, 1e14), 0.0}},
      {"hose.poisson", "", "Poisson's ratio of the wall", shapes_state,
       RealKey{FIELD(hose.poisson), 1, between(-1, 0.5), 0.48}},
      {"hose.inlet_length_mm", "mm", "length of the hose from the inlet to the begin of the track",
       shapes_state, RealKey{FIELD(hose.inlet_length), cm_per_mm, above_to(0, 1e6), {}}},
      {"hose.outlet_length_mm", "mm", "length of the hose from the end of the track to the outlet",
       shapes_state, RealKey{FIELD(hose.outlet_length), cm_per_mm, above_to(0, 1e6), {}}},
      {"hose.throat_recovery", "",
       "part of the kinetic energy that returns to pressure where the flow leaves a squeezed place; 1: "
       "Bernoulli",
       shapes_state, RealKey{FIELD(hose.throat_recovery), 1, from_to(0, 1), 0.0}},
      {"hose.entry_loss", "", "kinetic energy lost where the flow enters the hose, as a part of it",
       shapes_state, RealKey{FIELD(hose.entry_loss), 1, from_to(0, 10), 0.5}},
      {"rollers.count", "", "rollers, evenly spaced on the rotor", shapes_state,
       IntegerKey{FIELD(rollers.count), 1, 100, std::nullopt}},
      {"rollers.radius_mm", "mm", "radius of a roller", shapes_state,
       RealKey{FIELD(rollers.radius), cm_per_mm, above_to(0, 1e4), {}}},
      {"rollers.track_radius_mm", "mm", "radius of the wall that the hose lies against", shapes_state,
       RealKey{FIELD(rollers.track_radius), cm_per_mm, above_to(0, 1e5), {}}},
      {"rollers.track_angle_deg", "deg",
       "angle over which that wall is concentric with the rotor; it ends in straight tangents", shapes_state,
       RealKey{FIELD(rollers.track_angle), radians, above_to(0, 360), {}}},
      {"rollers.occlusion", "",
       "how far a roller closes the bore: 1 - height under the roller / bore; 1: to the film", shapes_state,
       RealKey{FIELD(rollers.occlusion), 1, above_to(0, 1), {}}},
      {"rollers.film_mm", "mm",
       "height of the film of fluid that a roller leaves, the least height of the bore", shapes_state,
       RealKey{FIELD(rollers.film), cm_per_mm, above_to(0, 1e3), 0.01}},
  };
}

std::vector<SceneKey> actuator_keys() {
  constexpr double dyn_per_cm_of_N_per_mm = 1e6, dyn_s_per_cm_of_N_s_per_m = 1e3, cm_per_s2_of_m_per_s2 = 100;
  const auto part = [](const char* path, const char* unit, const char* help,
                       std::function<double&(Scene&)> field, double cgs_per_unit, double high) {
    return SceneKey{path, unit, help, shapes_state,
                    RealKey{std::move(field), cgs_per_unit, from_to(0, high), 0.0}};
  };
  return {
      part("actuator.force_N_per_V", "N_per_V", "force on a holder at rest per volt",
           FIELD(actuator.force_per_volt), units::dyn_per_N, 1e6),
      part("actuator.moving_mass_g", "g", "mass that moves with the holder, the membrane left out",
           FIELD(actuator.moving_mass), 1, 1e6),
      part("actuator.suspension_N_per_mm", "N_per_mm", "stiffness of the suspension",
           FIELD(actuator.stiffness), dyn_per_cm_of_N_per_mm, 1e9),
      part("actuator.damping_N_s_per_m", "N_s_per_m",
           "damping of the holder; without that of the coil where its resistance is stated",
           FIELD(actuator.damping), dyn_s_per_cm_of_N_s_per_m, 1e9),
      part("actuator.coil_resistance_ohm", "ohm",
           "resistance of the coil; its back-EMF damps by force_per_volt^2 * resistance; 0: not stated",
           FIELD(actuator.coil_resistance), 1, 1e6),
      {"actuator.gravity_m_per_s2", "m_per_s2",
       "gravity along the axis, on the moving mass; 9.81 upwards of the drawing, -9.81 downwards. Buoyancy "
       "and the "
       "membrane's weight are left out",
       shapes_state, RealKey{FIELD(actuator.gravity), cm_per_s2_of_m_per_s2, from_to(-1000, 1000), 0.0}},
      part("actuator.stop_mm", "mm", "displacement at which the holder meets an end stop; 0: no stops",
           FIELD(actuator.stop), cm_per_mm, 1e3),
      part("actuator.stop_N_per_mm", "N_per_mm", "stiffness of the end stops", FIELD(actuator.stop_stiffness),
           dyn_per_cm_of_N_per_mm, 1e9),
  };
}

std::vector<SceneKey> blood_keys() {
  return {
      {"blood.damage_coefficient_percent", "",
       "free haemoglobin in percent = this * (scalar stress in Pa)^stress_exponent * seconds^time_exponent: "
       "a law "
       "for comparing designs, orders of magnitude off in absolute terms. Default: Zhang et al. 2011; "
       "Giersiepen et al. 1990: 3.62e-5, 2.416, 0.785; Heuser & Opitz 1980: 1.8e-6, 1.991, 0.765. Finite "
       "elements alone",
       leaves_state, RealKey{FIELD(blood.coefficient), 1, from_to(0, 1), 1.228e-5}},
      {"blood.damage_stress_exponent", "", "see `damage_coefficient_percent`", leaves_state,
       RealKey{FIELD(blood.stress_exponent), 1, above_to(0, 10), 1.9918}},
      {"blood.damage_time_exponent", "", "see `damage_coefficient_percent`", leaves_state,
       RealKey{FIELD(blood.time_exponent), 1, above_to(0, 1), 0.6606}},
      {"blood.stress_threshold_Pa", "Pa", "scalar stress beyond which the volume of fluid is counted",
       leaves_state, RealKey{FIELD(blood.threshold), units::dyn_per_cm2_per_Pa, from_to(0, 1e6), 50.0}},
  };
}

std::vector<SceneKey> mesh_keys() {
  return {
      {"mesh.gap_elements", "", "elements across the narrowest clearance between solids and walls",
       shapes_state, RealKey{FIELD(mesh.gap_elements), 1, from_to(2, 1000), 5.0}},
      {"mesh.channel_size_mm", "mm", "element size in the channels", shapes_state,
       RealKey{FIELD(mesh.channel_size), cm_per_mm, above_to(0, 1e4), {}}},
      {"mesh.membrane_size_mm", "mm", "element size of the membrane's own mesh", shapes_state,
       RealKey{FIELD(mesh.membrane_size), cm_per_mm, above_to(0, 1e4), {}}},
      {"mesh.growth", "", "increase of element size per unit distance from a gap", shapes_state,
       RealKey{FIELD(mesh.growth), 1, above_to(0, 10), 0.3}},
  };
}

std::vector<SceneKey> period_keys() {
  return {
      {"time.steps_per_period", "", "time steps per period of the actuator, or per turn of the rotor",
       shapes_state, IntegerKey{FIELD(time.steps_per_period), 8, 1000000, 96}},
      {"time.periods", "", "periods to compute", leaves_state,
       IntegerKey{FIELD(time.periods), 1, 1000000, 10}},
      {"time.flow_error_l_per_min", "l_per_min",
       "a run ends before its last period once the standard error of its mean flow is below this, by at "
       "least "
       "six periods; 0: it does not",
       leaves_state, RealKey{FIELD(time.flow_error), units::flow_from_l_per_min(1), from_to(0, 1000), 0.0}},
      {"time.ramp_periods", "", "stroke and head rise smoothly over this many periods", shapes_state,
       RealKey{FIELD(time.ramp_periods), 1, from_to(0, 1000000), 1.0}, Scope::wave_pump},
  };
}

std::vector<SceneKey> duration_keys() {
  return {
      {"time.step_s", "s", "time step of scenes with [domain] or [body.NAME]", shapes_state,
       RealKey{FIELD(time.step), 1, above_to(0, 1e6), {}}},
      {"time.end_s", "s", "time to compute to, in scenes with [domain] or [body.NAME]", leaves_state,
       RealKey{FIELD(time.end), 1, above_to(0, 1e9), {}}},
  };
}

std::vector<SceneKey> domain_keys() {
  return {
      {"domain.outline_mm", "mm", "corners of the fluid's domain, in either direction", shapes_state,
       PositionListKey{FIELD(problem.domain.shape.outline), cm_per_mm}},
      {"domain.centre_mm", "mm", "centre of a round domain", shapes_state,
       PositionKey{FIELD(problem.domain.shape.centre), cm_per_mm}},
      {"domain.radius_mm", "mm", "radius of a round domain, in place of `outline_mm`", shapes_state,
       RealKey{FIELD(problem.domain.shape.radius), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"domain.sides", "", "name of the side from each corner to the next; of a round domain its only one",
       shapes_state, NameListKey{FIELD(problem.domain.sides)}},
      {"domain.size_mm", "mm", "largest element size of the fluid", shapes_state,
       RealKey{FIELD(problem.domain.size), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"domain.growth", "", "increase of the size per unit distance from where it is refined", shapes_state,
       RealKey{FIELD(problem.domain.growth), 1, above_to(0, 10), 0.2}},
      {"domain.body_force_dyn_per_cm3", "dyn_per_cm3", "force on the fluid", shapes_state,
       ExpressionPairKey{FIELD(problem.body_force)}},
  };
}

std::vector<SceneKey> statistics_keys() {
  return {
      {"output.statistics_from_s", "s",
       "begin of the window from which statistics.csv takes mean, amplitude and frequency", leaves_state,
       RealKey{FIELD(output.statistics_from), 1, from_to(0, 1e9), 0.0}},
  };
}

std::vector<SceneKey> scoped(Scope scope, std::vector<SceneKey> keys) {
  for (SceneKey& key : keys) {
    if (key.scope == Scope::any) {
      key.scope = scope;
    }
  }
  return keys;
}

std::vector<SceneKey> numerics_keys() {
  constexpr int many = std::numeric_limits<int>::max();
  return {
      {"time.scheme", "", "time stepping", shapes_state,
       choice<FIELD(time.scheme)>({name("bdf1", TimeScheme::bdf1), name("bdf2", TimeScheme::bdf2)}, {},
                                  "bdf2")},
      {"time.factor_every", "",
       "most steps that share one factorisation; GMRES corrects the rest, and factors that it does not get "
       "on with are made anew; domains that move factor every step",
       shapes_state, IntegerKey{FIELD(time.factor_every), 1, 1000, 1}},
      {"time.newton_tolerance", "",
       "nonlinear solids: balance of forces at which Newton ends, relative to the internal forces",
       shapes_state, RealKey{FIELD(time.newton.tolerance), 1, between(0, 1), NewtonSettings{}.tolerance}},
      {"time.newton_iterations", "", "nonlinear solids: iterations of Newton after which a step has failed",
       shapes_state, IntegerKey{FIELD(time.newton.max_iterations), 1, 1000, NewtonSettings{}.max_iterations}},
      {"time.convection_tolerance", "",
       "how far the velocity that convects, extrapolated from the steps before, may be from that of the "
       "step's "
       "answer, by kinetic energy, before it is taken from the answer; 0: it is extrapolated always",
       shapes_state, RealKey{FIELD(time.convection.tolerance), 1, from_to(0, 1), 0.0, std::nullopt, 0.001}},
      {"time.extrapolation", "",
       "where a step expects the solids at its end, other couplings than `fixed`; `first`: d + dt v; "
       "`second`: "
       "of second order in time",
       shapes_state,
       choice<FIELD(time.motion.extrapolation)>(
           {name("first", Extrapolation::first), name("second", Extrapolation::second)}, {}, "second")},
      {"time.coupling_tolerance_mm", "mm",
       "implicit coupling: largest difference between placed and computed displacement", shapes_state,
       RealKey{FIELD(time.motion.tolerance), cm_per_mm, above_to(0, 10), 1e-4}},
      {"time.coupling_iterations", "",
       "implicit and mapped coupling: turns of placing and solving after which a step is halved",
       shapes_state, IntegerKey{FIELD(time.motion.max_iterations), 1, 1000, MotionSettings{}.max_iterations}},
      {"time.halvings", "",
       "how often a step that fails, or that would take solids through a wall, may be halved; other "
       "couplings "
       "than `fixed`",
       shapes_state, IntegerKey{FIELD(time.motion.max_halvings), 0, 30, MotionSettings{}.max_halvings}},
      {"time.film_change", "",
       "largest change of a gap in the film of contact within a step, relative to the smaller one, before "
       "the step "
       "is taken in parts (eight at most); 0: any",
       shapes_state, RealKey{FIELD(time.motion.film_change), 1, from_to(0, 1e3), 0.0}},
      {"contact.film_mm", "mm",
       "thickness of the film of fluid kept between solids and walls; 0: no law of contact", shapes_state,
       RealKey{FIELD(contact.film), cm_per_mm, from_to(0, 10), 0.0}},
      {"contact.stiffness_dyn_per_cm2", "dyn_per_cm2",
       "pressure of contact = stiffness * (film / gap - 1), for gaps below the film", shapes_state,
       RealKey{FIELD(contact.stiffness), 1, from_to(0, 1e15), 0.0}},
      {"contact.slip_length_mm", "mm",
       "Navier's slip length on the solids' skin, with `interface = \"slip\"`", shapes_state,
       RealKey{FIELD(contact.slip), cm_per_mm, from_to(0, 1e4), 0.0}},
      {"output.fields_every", "", "steps between field files; 0: none", leaves_state,
       IntegerKey{FIELD(output.fields_every), 0, many, 0}},
      {"output.checkpoint_every", "",
       "steps between checkpoints; 0: none; -1: at the end of every period of a pump, and a minute after the "
       "last one",
       leaves_state,
       IntegerKey{FIELD(output.checkpoint_every), automatic_checkpoints, many, automatic_checkpoints}},
  };
}

std::vector<SceneKey> stabilisation_keys() {
  // Scales of 0 are derived where a problem is made.
  static constexpr StabilisationWeights derived = derived_weights(0, 0),
                                        published = published_weights(100, 2e-4),
                                        quadratic = derived_weights(0, 0, 2);
  using Weight = double StabilisationWeights::*;
  const auto key = [](const char* path, const char* unit, const char* help, Weight weight,
                      AllowedRange allowed) {
    return SceneKey{path, unit, help, shapes_state,
                    RealKey{[weight](Scene& scene) -> double& { return scene.stabilisation.*weight; }, 1,
                            allowed, derived.*weight, published.*weight, std::nullopt}};
  };
  const auto weight = [&](const char* path, const char* help, Weight member,
                          AllowedRange allowed = from_to(0, 1e6)) {
    SceneKey result = key(path, "", help, member, allowed);
    std::get<RealKey>(result.value).quadratic = quadratic.*member;
    return result;
  };
  using Weights = StabilisationWeights;
  auto scale = choice<FIELD(stabilisation.velocity_scale)>(
      {name("reference", VelocityScale::reference), name("local", VelocityScale::local)}, {}, "local");
  scale.published = "reference";
  return {
      {"stabilisation.weights", "",
       "where the other keys of this section start from; `derived`: for Re 0 to 1000, with scales from the "
       "scene; `published`: those of the pump of fixed geometry, the same for all operating points, as "
       "reduced "
       "models need them",
       shapes_state,
       choice<FIELD(default_weights)>(
           {name("derived", DefaultWeights::derived), name("published", DefaultWeights::published)}, {},
           "derived")},
      weight("stabilisation.velocity_jump", "jump of the velocity gradient (convection)",
             &Weights::velocity_jump),
      {"stabilisation.velocity_scale", "",
       "velocity in velocity_jump; `reference`: the same everywhere, as reduced models need it; `local`: "
       "that of the flow across each facet, none along a wall",
       shapes_state, std::move(scale)},
      weight("stabilisation.pressure_jump", "jump of the pressure gradient", &Weights::pressure_jump),
      weight("stabilisation.divergence", "jump of the divergence", &Weights::divergence),
      weight("stabilisation.ghost_viscous", "ghost penalty of cut parts, viscous scale",
             &Weights::ghost_viscous),
      weight("stabilisation.ghost_inertial", "ghost penalty of cut parts, inertial scale",
             &Weights::ghost_inertial),
      weight("stabilisation.ghost_pressure", "ghost penalty of cut parts, pressure",
             &Weights::ghost_pressure),
      weight("stabilisation.nitsche_viscous", "Nitsche penalty, times viscosity / h",
             &Weights::nitsche_viscous, above_to(0, 1e6)),
      weight("stabilisation.nitsche_normal", "Nitsche penalty on the normal component",
             &Weights::nitsche_normal),
      key("stabilisation.reference_velocity_cm_per_s", "cm_per_s",
          "velocity that scales the weights; 0: the greatest that the scene states, or that its pressures "
          "and forces could give; of a pump, membrane's width * frequency",
          &Weights::reference_velocity, from_to(0, 1e6)),
      key("stabilisation.reference_time_s", "s", "time that scales the weights; 0: the time step",
          &Weights::reference_time, from_to(0, 1e6)),
  };
}

std::vector<SceneKey> thin_gap_keys() {
  const auto part = [](const char* path, const char* help, std::function<double&(Scene&)> field, double high,
                       double fallback) {
    return SceneKey{path, "", help, shapes_state, RealKey{std::move(field), 1, from_to(0, high), fallback}};
  };
  return {
      {"thin_gap.cells", "", "cells over the membrane's radius, from the tip to the rim", shapes_state,
       IntegerKey{FIELD(thin_gap.cells), 16, 10000, 64}},
      {"thin_gap.film_thickness_mm", "mm", "height of a gap at which contact with the wall sets in",
       shapes_state, RealKey{FIELD(thin_gap.film_thickness), cm_per_mm, above_to(0, 10), 0.05}},
      {"thin_gap.contact_stiffness_dyn_per_cm3", "dyn_per_cm3",
       "pressure of contact per depth below the film thickness", shapes_state,
       RealKey{FIELD(thin_gap.contact_stiffness), 1, from_to(0, 1e15), 1e9}},
      part("thin_gap.throat_recovery",
           "part of the kinetic energy that returns to pressure where the flow of a gap slows down; 1: "
           "Bernoulli",
           FIELD(thin_gap.throat_recovery), 1, 0.0),
      part("thin_gap.exit_recovery", "the same where the flow leaves a gap or a channel",
           FIELD(thin_gap.exit_recovery), 1, 0.0),
      part("thin_gap.entry_loss",
           "kinetic energy lost where the flow enters a gap or a channel, as a part of it",
           FIELD(thin_gap.entry_loss), 10, 0.5),
      {"thin_gap.momentum_factor", "",
       "of the velocity over a gap's height: 1 for a plug, 1.2 for a parabola", shapes_state,
       RealKey{FIELD(thin_gap.momentum_factor), 1, from_to(1, 2), 1.0}},
      {"thin_gap.friction", "",
       "wall friction; `oscillatory`: no weaker than that of two Stokes layers of the actuator's frequency",
       shapes_state,
       choice<FIELD(thin_gap.friction)>(
           {name("poiseuille", GapFriction::poiseuille), name("oscillatory", GapFriction::oscillatory)}, {},
           "poiseuille")},
      {"thin_gap.newton_tolerance", "",
       "change of the unknowns at which Newton ends, relative to their scales", shapes_state,
       RealKey{FIELD(thin_gap.newton_tolerance), 1, between(0, 1), 1e-5}},
  };
}

std::vector<SceneKey> training_keys() {
  const auto bound = [](const char* path, const char* unit, const char* help, double& (*field)(Scene&),
                        double cgs_per_unit, AllowedRange allowed, double fallback) {
    return SceneKey{path, unit, help, leaves_state,
                    RealKey{std::move(field), cgs_per_unit, allowed, fallback}};
  };
  const auto count = [](const char* path, const char* help, std::function<int&(Scene&)> field, int low,
                        int fallback) {
    return SceneKey{path, "", help, leaves_state, IntegerKey{std::move(field), low, 100000, fallback}};
  };
  std::vector<SceneKey> keys = {
      {"training.model", "",
       "what `train` makes of its runs: a model projected from their snapshots, or an emulator, which "
       "interpolates "
       "what they come to, of any level",
       leaves_state,
       choice<FIELD(training.model)>(
           {name("projected", ModelKind::projected), name("emulator", ModelKind::emulator)}, {},
           "projected")},
      bound("training.frequency_low_Hz", "Hz", "lowest frequency of the box", FIELD(training.frequency_low),
            1, above_to(0, 1e5), 80),
      bound("training.frequency_high_Hz", "Hz", "highest frequency of the box",
            FIELD(training.frequency_high), 1, above_to(0, 1e5), 140),
      bound("training.stroke_low_mm", "mm", "lowest stroke of the box", FIELD(training.stroke_low), cm_per_mm,
            from_to(0, 100), 0.1),
      bound("training.stroke_high_mm", "mm", "highest stroke of the box", FIELD(training.stroke_high),
            cm_per_mm, from_to(0, 100), 0.8),
      bound("training.voltage_low_V", "V", "lowest voltage of the box, where a voltage drives",
            FIELD(training.voltage_low), 1, from_to(0, 1e6), 30),
      bound("training.voltage_high_V", "V", "highest voltage of the box, where a voltage drives",
            FIELD(training.voltage_high), 1, from_to(0, 1e6), 50),
      bound("training.head_low_mmHg", "mmHg", "lowest head of the box", FIELD(training.head_low), mmHg,
            from_to(-1e4, 1e4), 0),
      bound("training.head_high_mmHg", "mmHg", "highest head of the box", FIELD(training.head_high), mmHg,
            from_to(-1e4, 1e4), 70),
      {"training.vary", "",
       "emulators: other keys that are inputs, each with its range, "
       "[\"membrane.young_dyn_per_cm2=1.5e7:1.9e7\"]",
       leaves_state, NameListKey{FIELD(training.vary)}},
      count("training.training_points", "space-filling points, besides the corners of the box",
            FIELD(training.training_points), 0, 16),
      count("training.held_out_points", "points kept out of the basis to measure its error",
            FIELD(training.held_out_points), 0, 8),
      count("training.snapshots_per_period", "snapshots per period; divides `time.steps_per_period`",
            FIELD(training.snapshots_per_period), 1, 24),
      count("training.sampled_periods", "periods at the end of each run that give snapshots",
            FIELD(training.sampled_periods), 1, 1),
      count("training.velocity_modes", "velocity modes; 0: by `energy_tolerance`",
            FIELD(training.velocity_modes), 0, 0),
      count("training.pressure_modes", "pressure modes; 0: by `energy_tolerance`",
            FIELD(training.pressure_modes), 0, 0),
      count("training.displacement_modes", "displacement modes; 0: by `energy_tolerance`",
            FIELD(training.displacement_modes), 0, 0),
      {"training.pressure_stability", "",
       "what ties the reduced pressure to the momentum balance: the projected stabilisation alone, or "
       "supremizers "
       "beside it",
       leaves_state,
       choice<FIELD(training.pressure_stability)>(
           {name("projected-stabilisation", PressureStability::projected_stabilisation),
            name("supremizers", PressureStability::supremizers)},
           {}, "projected-stabilisation")},
      bound("training.energy_tolerance", "", "energy that the modes may miss, as a part of the whole",
            FIELD(training.energy_tolerance), 1, between(0, 1), 1e-6),
      bound("training.cubature_error", "",
            "of a moving domain: part of the projected forces that the weighted sums over a few elements may "
            "miss; 0: sums over all elements, the one that is safe: docs/moving_model.md",
            FIELD(training.cubature_error), 1, from_to(0, 1), 0.0),
      bound("training.periodic_tolerance", "",
            "change of the velocity over a period at which a run counts as periodic",
            FIELD(training.periodic_tolerance), 1, between(0, 1), 2e-3),
      count("training.ranks_per_run", "MPI ranks that share one run of `train` or `study`",
            FIELD(training.ranks_per_run), 1, 1),
  };
  for (SceneKey& key : keys) {
    for (const char* path : {"training.head_low_mmHg", "training.head_high_mmHg",
                             "training.periodic_tolerance", "training.ranks_per_run"}) {
      if (key.path == path) {
        key.scope = Scope::pump;
      }
    }
  }
  return keys;
}

#undef FIELD

} // namespace

std::span<const SceneKey> scene_table() {
  static const std::vector<SceneKey> table = [] {
    std::vector<SceneKey> all;
    for (const auto& part :
         {model_keys(), scoped(Scope::wave_pump, geometry_keys()), scoped(Scope::general, domain_keys()),
          scoped(Scope::peristaltic_pump, hose_keys()), fluid_keys(), scoped(Scope::wave_pump, pump_keys()),
          scoped(Scope::wave_pump, actuator_keys()), scoped(Scope::wave_pump, blood_keys()),
          scoped(Scope::wave_pump, mesh_keys()), numerics_keys(), scoped(Scope::pump, period_keys()),
          scoped(Scope::general, duration_keys()), scoped(Scope::general, statistics_keys()),
          stabilisation_keys(), scoped(Scope::wave_pump, thin_gap_keys()),
          scoped(Scope::wave_pump, training_keys())}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    for (SceneKey& key : all) {
      for (const char* path : {"model.extent", "model.solid", "model.inlet", "model.outlet"}) {
        if (key.path == path) {
          key.scope = Scope::wave_pump;
        }
      }
    }
    // A section in one piece, whatever scenes have its keys.
    std::vector<std::string> sections;
    for (const SceneKey& key : all) {
      if (std::find(sections.begin(), sections.end(), key.section()) == sections.end()) {
        sections.push_back(key.section());
      }
    }
    std::vector<SceneKey> sorted;
    for (const std::string& section : sections) {
      for (const SceneKey& key : all) {
        if (key.section() == section) {
          sorted.push_back(key);
        }
      }
    }
    return sorted;
  }();
  return table;
}

std::string section_help(const std::string& section) {
  static const std::array<std::pair<const char*, const char*>, 18> help = {{
      {"model", "Which equations are built. What is not chosen is not assembled."},
      {"space", "Finite elements of the fluid."},
      {"geometry", "Of a wave pump: either a profile, or meshes made elsewhere."},
      {"hose", "The hose of a peristaltic pump (docs/peristaltic.md)."},
      {"rollers", "Its rollers, and the track that they press the hose against."},
      {"domain", "The fluid's domain of any other problem: a polygon or a circle, with holes ([hole.NAME])."},
      {"fluid", "Newtonian, incompressible."},
      {"membrane", "Material of the membrane and the region that the actuator holds."},
      {"operating_point", "What the pump is driven with."},
      {"blood",
       "What the flow does to blood, by the stress of a pump's finite elements: a law of haemolysis to "
       "compare "
       "designs by."},
      {"actuator",
       "The motor of `drive = \"voltage\"`: a force in proportion to the voltage on a mass with a suspension "
       "(docs/drive.md)."},
      {"mesh", "Element sizes for meshes made from a profile."},
      {"time", "The time step is the period over `steps_per_period`, or `step_s`."},
      {"contact", "Solids that come close to walls, and the slip that lets them (finite elements)."},
      {"output", "Files besides the time series and the cycle means."},
      {"stabilisation",
       "Weights of the stabilised cut finite elements. The defaults suit a new scene "
       "(docs/writing_a_scene.md)."},
      {"thin_gap",
       "Closures of the thin-gap level (`model.space = \"thin-gap\"`). Heights, areas and inertances "
       "come from the profile."},
      {"training", "Box, sampling plan and basis of a reduced model."},
  }};
  for (const auto& [key, text] : help) {
    if (section == key) {
      return text;
    }
  }
  return "";
}

} // namespace undula::fom
