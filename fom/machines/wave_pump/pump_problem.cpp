#include "fom/machines/wave_pump/pump_problem.hpp"

#include <algorithm>

#include "fom/fom.hpp"
#include "fom/machines/wave_pump/pump_checks.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/scene_time.hpp"
#include "geometry/mesh/gmsh_import.hpp"
#include "geometry/wave_pump/profile_scale.hpp"
#include "geometry/wave_pump/pump.hpp"

namespace undula::fom {

PumpProfile scene_profile(const Scene& scene) {
  auto profile =
      scale_clearances(read_pump_profile(scene.profile), scene.clearance_scale, scene.rim_gap_scale);
  if (scene.clamp_radius > 0)
    check_clamp_radius(scene, profile.membrane.inner_radius, profile.membrane.outer_radius,
                       "the membrane has");
  // The mesh keeps a line where the motion is imposed from.
  const double clamp = scene.clamp_radius;
  if (clamp > profile.membrane.inner_radius && std::abs(clamp - profile.membrane.clamp_radius) > 1e-9 * clamp)
    profile.membrane.clamp_radius = clamp;
  round_corners(scene, profile);
  return profile;
}

namespace {

struct PumpMeshes {
  SimplexMesh<2> background;
  std::vector<SimplexMesh<2>> solids; ///< the membrane first
  double clamp_radius = 0;            ///< cm
};

PumpMeshes pump_meshes(const Scene& scene) {
  PumpMeshes meshes;
  meshes.clamp_radius = scene.clamp_radius;
  if (scene.profile.empty()) {
    const double unit = mesh_unit_length(scene);
    meshes.background = import_gmsh<2>(scene.fluid_mesh, unit).mesh;
    for (const auto& file : scene.solid_meshes) meshes.solids.push_back(import_gmsh<2>(file, unit).mesh);
    check_imported_meshes(scene, meshes.background, meshes.solids);
    double inner = HUGE_VAL, outer = 0;
    for (const auto& x : meshes.solids.front().points) {
      inner = std::min(inner, x[0]);
      outer = std::max(outer, x[0]);
    }
    check_clamp_radius(scene, inner, outer,
                       "the membrane, mesh " + scene.solid_meshes.front().filename().string() + ", has");
    return meshes;
  }
  auto profile = scene_profile(scene);
  check_pump_work(scene, profile);
  const PumpMeshSizes sizes{scene.mesh.gap_elements, scene.mesh.channel_size, scene.mesh.membrane_size,
                            scene.mesh.growth};
  meshes.background = pump_background(profile, sizes, refinement_boxes(scene.problem));
  meshes.solids = {pump_membrane(profile, sizes), pump_magnet(profile, sizes)};
  if (meshes.clamp_radius == 0) meshes.clamp_radius = profile.membrane.clamp_radius;
  return meshes;
}

/// Speed of a wave that runs over the membrane once per period.
double wave_speed(const Scene& scene, const SimplexMesh<2>& membrane) {
  const auto [inner, outer] = std::minmax_element(membrane.points.begin(), membrane.points.end(),
                                                  [](const auto& a, const auto& b) { return a[0] < b[0]; });
  return ((*outer)[0] - (*inner)[0]) * scene.operating_point.frequency;
}

} // namespace

std::optional<DrivenHolder> driven_holder(const Scene& scene) {
  if (scene.operating_point.drive != Drive::voltage) return std::nullopt;
  return DrivenHolder{scene.actuator, [scene](double t) { return drive_voltage(scene, t); }};
}

FsiProblem<2> pump_problem(const Scene& scene) {
  auto meshes = pump_meshes(scene);
  auto problem = problem_without_meshes(scene);
  problem.stabilisation = weights_in_force(scene, wave_speed(scene, meshes.solids.front()));
  problem.background = std::move(meshes.background);
  problem.holder = driven_holder(scene);

  using Condition = BoundaryCondition<2>;
  for (const auto& name : problem.background.boundary_names) {
    Condition condition;
    if (name == inlet_name || name == outlet_name) {
      condition.kind = Condition::Kind::opening;
      condition.opening = name == inlet_name ? scene.inlet : scene.outlet;
      if (name == outlet_name) condition.pressure = [scene](double t) { return outlet_pressure(scene, t); };
    } else if (name == "axis") {
      condition.kind = Condition::Kind::symmetry;
    }
    problem.boundary.emplace(name, condition);
  }
  for (std::size_t s = 0; s < meshes.solids.size(); ++s) {
    SolidBody<2> body;
    body.mesh = std::move(meshes.solids[s]);
    body.imposed_displacement = [scene](const Point<2>&, double t) {
      return Point<2>(0.0, holder_displacement(scene, t));
    };
    if (s == 0) {
      body.name = "membrane";
      body.properties = scene.membrane;
      body.model = scene.solid_model;
      // Nodes on the clamp line itself are imposed: it is a mesh line, up to rounding.
      const double from = meshes.clamp_radius * (1 - 1e-9);
      body.imposed = [from](const Point<2>& x) { return x[0] >= from; };
    } else {
      // Moves as a whole, so its elasticity and inertia do not enter.
      body.name = "holder_" + std::to_string(s);
      body.imposed = [](const Point<2>&) { return true; };
    }
    problem.solids.push_back(std::move(body));
  }
  return problem;
}

} // namespace undula::fom
