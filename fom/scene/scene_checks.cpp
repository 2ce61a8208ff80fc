#include "fom/scene/scene_checks.hpp"

#include <algorithm>

#include "fom/scene/hose_checks.hpp"
#include "fom/scene/key_place.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_value.hpp"
#include "fom/scene/statement_checks.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

void check_geometry(const Scene& scene, const std::string& where) {
  const bool has_meshes = !scene.fluid_mesh.empty() || !scene.solid_meshes.empty();
  if (scene.profile.empty() == !has_meshes) {
    throw InputError("the geometry is not stated in exactly one way",
                     has_meshes ? "both \"geometry.profile\" and meshes" : "neither a profile nor meshes",
                     "either \"geometry.profile\", or \"geometry.fluid_mesh\" with \"geometry.solid_meshes\"",
                     where + ", section [geometry]");
  }
  if (has_meshes && scene.fluid_mesh.empty()) {
    throw InputError("\"geometry.solid_meshes\" stands without a mesh of the fluid",
                     "no \"geometry.fluid_mesh\"", "\"geometry.fluid_mesh\", a Gmsh file",
                     where + ", section [geometry]");
  }
  if (has_meshes && scene.solid_meshes.empty()) {
    throw InputError("a pump has no membrane", "no \"geometry.solid_meshes\"",
                     "\"geometry.solid_meshes\", the mesh of the membrane first",
                     place_of_key(scene, "geometry.solid_meshes", where));
  }
  if (!has_meshes && scene.mesh_unit != MeshUnit::cm) {
    throw InputError("a unit of meshes stands without meshes", "\"geometry.mesh_unit\" with a profile",
                     "\"geometry.fluid_mesh\" and \"geometry.solid_meshes\"; profiles are in cm",
                     place_of_key(scene, "geometry.mesh_unit", where));
  }
  if (has_meshes && (scene.clearance_scale != 1 || scene.rim_gap_scale != 1)) {
    throw InputError("gaps cannot be scaled without a profile",
                     "clearance_scale = " + shortest_number(scene.clearance_scale) +
                         ", rim_gap_scale = " + shortest_number(scene.rim_gap_scale) + " with Gmsh meshes",
                     "both 1, or \"geometry.profile\" in place of the meshes",
                     where + ", section [geometry]");
  }
}

void check_corners(const Scene& scene, const std::string& where) {
  const bool thin_gap = scene.space == Space::thin_gap;
  if ((scene.tip_radius > 0 || scene.rim_radius > 0) && (thin_gap || !scene.solid_meshes.empty())) {
    throw InputError(
        thin_gap ? "thin gaps know no corners of the membrane"
                 : "solids that come as meshes have the corners of their meshes",
        "tip_radius_mm = " + shortest_number(to_surface_unit(scene.tip_radius, units::cm_per_mm)) +
            ", rim_radius_mm = " + shortest_number(to_surface_unit(scene.rim_radius, units::cm_per_mm)),
        "both 0", where + ", section [membrane]");
  }
}

void check_clamp(const Scene& scene, const std::string& where) {
  if (!scene.solid_meshes.empty() && scene.clamp_radius == 0) {
    throw InputError("no profile says where the membrane is held", "clamp_radius_mm = 0",
                     "\"membrane.clamp_radius_mm\" > 0 where the solids come as meshes",
                     where + ", section [membrane]");
  }
}

/// Stiffness-proportional damping is stated once, and the plate of the thin gaps knows Kelvin-Voigt only.
void check_damping(const Scene& scene, const std::string& where) {
  const SolidProperties& solid = scene.membrane;
  const std::string seen = "damping_time_s = " + shortest_number(solid.damping_time) +
                           ", mass_damping_per_s = " + shortest_number(solid.mass_damping) +
                           ", stiffness_damping_s = " + shortest_number(solid.stiffness_damping);
  if (solid.damping_time > 0 && solid.stiffness_damping > 0) {
    throw InputError("damping in proportion to the stiffness is stated twice", seen,
                     "\"damping_time_s\" (Kelvin-Voigt) or \"stiffness_damping_s\" (Rayleigh), the other 0",
                     where + ", section [membrane]");
  }
  if (scene.space == Space::thin_gap && (solid.mass_damping > 0 || solid.stiffness_damping > 0)) {
    throw InputError("thin gaps know no Rayleigh damping", seen,
                     "\"damping_time_s\" alone, or space = \"axisymmetric\"", where + ", section [membrane]");
  }
}

/// A voltage drives an actuator that is stated.
void check_drive(const Scene& scene, const std::string& where) {
  const ActuatorSettings& actuator = scene.actuator;
  if ((actuator.stop > 0) != (actuator.stop_stiffness > 0)) {
    throw InputError("end stops are stated by half",
                     "stop_mm = " + shortest_number(to_surface_unit(actuator.stop, units::cm_per_mm)) +
                         ", a stiffness of " + shortest_number(actuator.stop_stiffness) + " dyn/cm",
                     "both positive, or both 0", where + ", section [actuator]");
  }
  if (scene.operating_point.drive != Drive::voltage) return;
  if (scene.operating_point.voltage == 0 && !scene.places.contains("operating_point.voltage_V")) {
    throw InputError("a voltage drives the holder, and none is stated", "no \"operating_point.voltage_V\"",
                     "\"operating_point.voltage_V\", the amplitude in V",
                     place_of_key(scene, "operating_point.drive", where));
  }
  if (actuator.force_per_volt == 0) {
    throw InputError("a voltage drives the holder, and makes no force", "force_N_per_V = 0",
                     "\"actuator.force_N_per_V\" > 0", place_of_key(scene, "actuator.force_N_per_V", where));
  }
  if (actuator.stiffness == 0) {
    throw InputError("nothing brings the holder back to its place", "suspension_N_per_mm = 0",
                     "\"actuator.suspension_N_per_mm\" > 0",
                     place_of_key(scene, "actuator.suspension_N_per_mm", where));
  }
}

void check_contact(const Scene& scene, const std::string& where) {
  const ContactSettings& contact = scene.contact;
  if (scene.space == Space::thin_gap &&
      (contact.film > 0 || contact.stiffness > 0 || contact.slip > 0 || scene.interface == Interface::slip)) {
    throw InputError("thin gaps have a law of contact of their own",
                     scene.interface == Interface::slip ? "interface = \"slip\"" : "keys of [contact]",
                     "\"thin_gap.film_thickness_mm\" and \"thin_gap.contact_stiffness_dyn_per_cm3\"",
                     where + ", section [contact]");
  }
  if ((contact.film > 0) != (contact.stiffness > 0)) {
    throw InputError("the law of contact is stated by half",
                     "film_mm = " + shortest_number(to_surface_unit(contact.film, units::cm_per_mm)) +
                         ", stiffness_dyn_per_cm2 = " + shortest_number(contact.stiffness),
                     "both positive, or both 0", where + ", section [contact]");
  }
  if ((contact.slip > 0) != (scene.interface == Interface::slip)) {
    throw InputError("slip is stated by half",
                     "slip_length_mm = " + shortest_number(to_surface_unit(contact.slip, units::cm_per_mm)) +
                         " with interface = " + (contact.slip > 0 ? "\"no-slip\"" : "\"slip\""),
                     "model.interface = \"slip\" with \"slip_length_mm\" > 0, or neither",
                     where + ", section [contact]");
  }
}

void check_levels(const Scene& scene, const std::string& where) {
  const bool thin_gap = scene.space == Space::thin_gap;
  if (thin_gap && scene.coupling != Coupling::implicit) {
    throw InputError("the geometric coupling does not go with the space",
                     std::string("coupling = \"") + coupling_name(scene.coupling) + "\" in thin gaps",
                     "coupling = \"implicit\": gaps follow the membrane", where + ", section [model]");
  }
  if (!thin_gap && scene.solid_model == SolidModel::von_karman) {
    throw InputError("the solid does not go with the space", "solid = \"von-karman\"",
                     "solid = \"linear\", or space = \"thin-gap\"", where + ", section [model]");
  }
  if (thin_gap && scene.solid_model != SolidModel::linear && scene.solid_model != SolidModel::von_karman) {
    throw InputError("the solid does not go with the space",
                     scene.solid_model == SolidModel::neo_hookean ? "solid = \"neo-hookean\""
                                                                  : "solid = \"saint-venant-kirchhoff\"",
                     "solid = \"von-karman\" or \"linear\" in thin gaps, whose membrane is a plate",
                     where + ", section [model]");
  }
  if (scene.velocity_order == 2 &&
      (thin_gap || (scene.coupling != Coupling::fixed && scene.coupling != Coupling::mapped))) {
    throw InputError("quadratic velocities do not go with the model",
                     thin_gap
                         ? std::string("order = 2 with space = \"thin-gap\"")
                         : std::string("order = 2 with coupling = \"") + coupling_name(scene.coupling) + "\"",
                     "order = 1, or coupling = \"fixed\" or \"mapped\"", where + ", section [space]");
  }
  if (thin_gap && scene.profile.empty()) {
    throw InputError("thin gaps need a profile", "meshes in its place", "\"geometry.profile\"",
                     where + ", section [geometry]");
  }
}

void check_time(const Scene& scene, const std::string& where) {
  if (const double steps = static_cast<double>(scene.time.periods) * scene.time.steps_per_period;
      steps > most_steps) {
    throw InputError("the run has too many time steps",
                     shortest_number(steps) + " steps, periods = " + std::to_string(scene.time.periods) +
                         ", steps_per_period = " + std::to_string(scene.time.steps_per_period),
                     "at most " + std::to_string(most_steps),
                     place_of_key(scene, "time.steps_per_period", where));
  }
  if (scene.time.ramp_periods > scene.time.periods) {
    throw InputError("the smooth start is longer than the run",
                     "ramp_periods = " + shortest_number(scene.time.ramp_periods),
                     "at most periods = " + std::to_string(scene.time.periods), where + ", section [time]");
  }
}

void check_bounds(const char* quantity, double low, double high, const std::string& where) {
  if (low > high) {
    throw InputError(std::string("the box of training is upside down in ") + quantity,
                     "low " + shortest_number(low) + ", high " + shortest_number(high), "low <= high",
                     where + ", section [training]");
  }
}

} // namespace

void check_consistency(const Scene& scene, const std::string& where) {
  check_refinements(scene, where);
  if (scene.problem.general) {
    check_statement(scene, where);
    check_contact(scene, where);
    return;
  }
  if (scene.machine == Machine::peristaltic_pump) {
    check_peristaltic_pump(scene, where);
    check_time(scene, where);
    return;
  }
  if (scene.space == Space::long_wave) {
    throw InputError("the space does not go with the machine", "space = \"long-wave\" for a wave pump",
                     "machine = \"peristaltic-pump\", or another space",
                     place_of_key(scene, "model.space", where));
  }
  check_geometry(scene, where);
  check_clamp(scene, where);
  check_corners(scene, where);
  check_levels(scene, where);
  check_contact(scene, where);
  check_damping(scene, where);
  check_drive(scene, where);
  check_time(scene, where);
}

void check_training(const Scene& scene, const std::string& where) {
  const TrainingPlan& plan = scene.training;
  check_bounds("head (mmHg)", units::pressure_to_mmHg(plan.head_low), units::pressure_to_mmHg(plan.head_high),
               where);
  if (scene.machine != Machine::wave_pump) return; // the heads of its curve are all that it states
  check_bounds("frequency (Hz)", plan.frequency_low, plan.frequency_high, where);
  if (scene.operating_point.drive == Drive::voltage)
    check_bounds("voltage (V)", plan.voltage_low, plan.voltage_high, where);
  else
    check_bounds("stroke (mm)", units::length_to_mm(plan.stroke_low), units::length_to_mm(plan.stroke_high),
                 where);
  if (plan.model == ModelKind::emulator) return; // it keeps no snapshots
  if (scene.time.steps_per_period % plan.snapshots_per_period != 0) {
    throw InputError("snapshots do not fall on time steps",
                     "snapshots_per_period = " + std::to_string(plan.snapshots_per_period),
                     "a divisor of time.steps_per_period = " + std::to_string(scene.time.steps_per_period),
                     where + ", section [training]");
  }
  if (plan.sampled_periods > scene.time.periods) {
    throw InputError(
        "more periods are sampled than computed", "sampled_periods = " + std::to_string(plan.sampled_periods),
        "at most time.periods = " + std::to_string(scene.time.periods), where + ", section [training]");
  }
}

bool states_training(const Scene& scene) {
  return std::any_of(scene.places.begin(), scene.places.end(),
                     [](const auto& place) { return place.first.starts_with("training."); });
}

} // namespace undula::fom
