#include "apps/input/scene_check.hpp"

#include <algorithm>
#include <set>

#include "fom/levels/scene_problem.hpp"
#include "fom/machines/peristaltic_pump/hose_remarks.hpp"
#include "fom/machines/wave_pump/pump_checks.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/general_observables.hpp"
#include "fom/scene/hose_checks.hpp"
#include "fom/scene/scene_checks.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_time.hpp"
#include "fom/scene/scene_value.hpp"
#include "fom/scene/statement_geometry.hpp"
#include "geometry/mesh/gmsh_import.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/sampling/varied_keys.hpp"

namespace undula::apps {
namespace {

CheckedMesh checked(const std::string& name, const SimplexMesh<2>& mesh) {
  CheckedMesh result;
  result.name = name;
  result.quality = mesh_quality(mesh);
  result.box = box_around<2>(mesh.points);
  return result;
}

/// Names of the boundaries where the flow is held.
std::vector<std::string> wall_names(const FsiProblem<2>& problem) {
  std::set<std::string> names;
  for (const auto& facet : problem.background.boundary) {
    const std::string& name = problem.background.boundary_names[static_cast<std::size_t>(facet.tag)];
    const auto& condition = problem.boundary.at(name);
    if (condition.kind == BoundaryCondition<2>::Kind::velocity && !condition.velocity) {
      names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

void add_files(const Scene& scene, SceneCheck& check) {
  if (scene.fluid_mesh.empty()) {
    return;
  }
  std::vector<std::filesystem::path> files = {scene.fluid_mesh};
  files.insert(files.end(), scene.solid_meshes.begin(), scene.solid_meshes.end());
  for (std::size_t i = 0; i < files.size(); ++i) {
    check.meshes[i].file = files[i].filename().string();
    check.meshes[i].reoriented = import_gmsh<2>(files[i], mesh_unit_length(scene)).reoriented_cells;
    if (check.meshes[i].reoriented > 0) {
      check.notes.push_back(std::to_string(check.meshes[i].reoriented) + " cells of " + check.meshes[i].file +
                            " go round clockwise and were turned");
    }
  }
  check.notes.push_back("the membrane is " + check.meshes[1].file +
                        (files.size() > 2 ? "; the other solids move with its holder" : ""));
}

double estimated_cells(const Scene& scene) {
  if (scene.problem.general) {
    const StatedWork work = check_statement_geometry(scene, scene.file.string());
    return work.fluid_cells + work.solid_cells;
  }
  if (scene.profile.empty()) {
    return 0;
  }
  const PumpWork work = check_pump_work(scene, scene_profile(scene));
  return work.fluid_cells + work.solid_cells;
}

std::vector<CheckedWeight> checked_weights(const Scene& scene, const StabilisationWeights& in_force) {
  Scene stated = scene, used = scene; // the accessors of the table give mutable references
  used.stabilisation = in_force;
  const std::string start = scene.default_weights == DefaultWeights::published ? "published" : "derived";
  std::vector<CheckedWeight> weights;
  for (const SceneKey& key : scene_table()) {
    const auto* real = std::get_if<RealKey>(&key.value);
    if (key.section() != "stabilisation" || real == nullptr) {
      continue;
    }
    const bool filled_in = real->field(stated) != real->field(used); // a scale of 0
    weights.push_back({key.leaf(), plain_number(to_surface_unit(real->field(used), real->cgs_per_unit)),
                       filled_in                                      ? "derived"
                       : scene.places.contains(key.path)              ? "stated"
                       : scene.velocity_order == 2 && real->quadratic ? "order 2"
                                                                      : start});
  }
  weights.push_back({"velocity_scale",
                     in_force.velocity_scale == VelocityScale::local ? "local" : "reference",
                     scene.places.contains("stabilisation.velocity_scale") ? "stated" : start});
  return weights;
}

/// A failure of the mesher or the cut, on one line.
std::string on_one_line(const std::exception& error) {
  std::string text = error.what();
  for (std::size_t at = text.find("\n  "); at != std::string::npos; at = text.find("\n  ")) {
    text.replace(at, 3, "; ");
  }
  return text;
}

SceneCheck mesh_and_cut(const Scene& scene) {
  SceneCheck check;
  if (states_training(scene)) {
    check_training(scene, scene.file.string());
    training::varied_keys(scene);
  }
  check.steps = last_step(scene);
  check.estimated_cells = estimated_cells(scene);
  check.notes = profile_differences(scene);
  if (scene.space == Space::thin_gap) {
    PhaseTimer timer;
    const ThinGapModel model = prepare_thin_gap(scene, timer);
    check.unknowns = unknowns(model);
    check.thin_gap = model.layout;
    return check;
  }
  if (scene.space == Space::long_wave) {
    check.hose = roller_track(scene);
    check.unknowns = 1;
    for (const std::string& remark : hose_remarks(scene)) {
      check.notes.push_back(remark);
    }
    return check;
  }
  FsiProblem<2> problem = scene_problem(scene);
  const bool fluid = !problem.background.cells.empty();
  if (fluid) {
    check.meshes.push_back(checked("background", problem.background));
    check.weights = checked_weights(scene, problem.stabilisation);
  }
  for (const SolidBody<2>& solid : problem.solids) {
    check.meshes.push_back(checked(solid.name, solid.mesh));
  }
  add_files(scene, check);
  check.walls = wall_names(problem);
  if (problem.pin_pressure && fluid) {
    check.notes.emplace_back("no boundary is an opening: the pressure counts from one point of the fluid");
  }
  const Discretisation<2> disc = discretise(std::move(problem), CutOptions{});
  check.unknowns = disc.unknowns();
  if (scene.problem.general) {
    plan_general_observables(disc, scene);
  }
  return check;
}

} // namespace

SceneCheck check_scene(const Scene& scene) {
  try {
    return mesh_and_cut(scene);
  } catch (const NumericsError& error) {
    // Nothing has been computed yet: what fails here is the geometry.
    throw InputError("the geometry of the scene cannot be meshed and cut", on_one_line(error),
                     "shapes without narrow places, bodies that neither touch nor cross each other",
                     scene.file.string());
  }
}

} // namespace undula::apps
