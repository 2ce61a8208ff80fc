#include "training/sampling/trainable_scene.hpp"

#include <string>

#include "fom/scene/common_problem.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::training {

bool has_mapped_domain(const Scene& scene) {
  return (scene.space == Space::plane || scene.space == Space::axisymmetric) &&
         scene.coupling == Coupling::mapped;
}

void require_trainable(const Scene& scene) {
  require_wave_pump(scene, "undula train");
  const auto refuse = [&](bool stated, const char* what, const std::string& seen, const char* allowed,
                          const char* section) {
    if (!stated) return;
    throw InputError(what, seen, allowed, scene.file.string() + ", section [" + section + "]");
  };
  if (scene.training.model == ModelKind::emulator) return; // it takes what any level computes
  if (has_mapped_domain(scene)) {
    refuse(scene.time.scheme != TimeScheme::bdf2,
           "a reduced model of a moving domain is made from steps of second order", "time.scheme = \"bdf1\"",
           "scheme = \"bdf2\"", "time");
    refuse(scene.operating_point.drive != Drive::voltage,
           "a reduced model of a moving domain is driven by a voltage", "operating_point.drive = \"stroke\"",
           "drive = \"voltage\", which leaves no motion imposed; training.model = \"emulator\"",
           "operating_point");
    refuse(scene.training.snapshots_per_period != scene.time.steps_per_period,
           "a model of a moving domain is made from every step of a period",
           "snapshots_per_period = " + std::to_string(scene.training.snapshots_per_period),
           "as many as time.steps_per_period", "training");
    return;
  }
  refuse(scene.space == Space::thin_gap, "a thin-gap scene needs no reduced model",
         "model.space = \"thin-gap\"",
         "undula hq on the scene itself, which takes seconds; training.model = \"emulator\"; or a scene of "
         "finite elements",
         "model");
  refuse(scene.coupling != Coupling::fixed, "a reduced model is projected from operators that never change",
         std::string("model.coupling = \"") + coupling_name(scene.coupling) + "\"", "coupling = \"fixed\"",
         "model");
  refuse(scene.solid_model != SolidModel::linear,
         "a reduced model is projected from linear operators of the solid",
         "a model.solid with a nonlinear law", "solid = \"linear\"", "model");
  refuse(scene.contact.film > 0, "a reduced model knows no contact", "contact.film_mm > 0",
         "no film, contact.film_mm = 0", "contact");
  refuse(scene.velocity_order == 2 &&
             scene.training.pressure_stability == PressureStability::projected_stabilisation,
         "quadratic velocities have no stabilisation of the pressure that could be projected",
         "space.order = 2 with pressure_stability = \"projected-stabilisation\"",
         "pressure_stability = \"supremizers\", or order = 1", "training");
  refuse(scene.time.convection.tolerance > 0,
         "a reduced model extrapolates the velocity that convects from the steps before",
         "time.convection_tolerance > 0", "convection_tolerance = 0", "time");
  refuse(scene.stabilisation.velocity_scale != VelocityScale::reference,
         "a reduced model is projected from penalties that do not depend on the flow",
         "stabilisation.velocity_scale = \"local\"", "weights = \"published\"", "stabilisation");
  refuse(scene.stabilisation.reference_velocity == 0 || scene.stabilisation.reference_time == 0,
         "a reduced model is projected from penalties that are the same at all operating points",
         "a reference_velocity_cm_per_s or reference_time_s of 0, to be derived",
         "weights = \"published\", or both > 0", "stabilisation");
  refuse(scene.operating_point.drive == Drive::voltage,
         "a reduced model of this version is driven by a stroke", "operating_point.drive = \"voltage\"",
         "drive = \"stroke\"", "operating_point");
  refuse(scene.operating_point.stroke_scale != 1, "a campaign states the stroke that the holder makes",
         "operating_point.stroke_scale = " + exact_number(scene.operating_point.stroke_scale),
         "1; ask the reduced model for the scaled stroke instead", "operating_point");
}

} // namespace undula::training
