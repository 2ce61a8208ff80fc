#include "fom/machines/wave_pump/pump_checks.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/key_place.hpp"
#include "fom/scene/outlined_problem.hpp"
#include "fom/scene/scene_table.hpp"
#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/refinement_box.hpp"
#include "geometry/wave_pump/membrane_outline.hpp"
#include "geometry/wave_pump/pump.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double rounding = 1e-9;

std::string mm(double length) { return plain_number(units::length_to_mm(length)); }

std::string name_of(const Scene& scene) {
  return scene.file.empty() ? "scene \"" + scene.name + '"' : scene.file.string();
}

std::string radii(double low, double high) { return "r from " + mm(low) + " to " + mm(high) + " mm"; }

struct RadialRange {
  double low = HUGE_VAL, high = -HUGE_VAL;
};

RadialRange radial_range(const SimplexMesh<2>& mesh) {
  RadialRange range;
  for (const auto& x : mesh.points) {
    range.low = std::min(range.low, x[0]);
    range.high = std::max(range.high, x[0]);
  }
  return range;
}

std::vector<Segment<2>> boundary_of(const SimplexMesh<2>& mesh) {
  std::vector<Segment<2>> edges;
  for (const auto& facet : mesh.boundary)
    edges.push_back({mesh.points[facet.points[0]], mesh.points[facet.points[1]]});
  return edges;
}

std::string used_names(const SimplexMesh<2>& mesh) {
  std::set<std::string> names;
  for (const auto& facet : mesh.boundary) names.insert(mesh.boundary_names[facet.tag]);
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

void check_radii(const Scene& scene, const SimplexMesh<2>& mesh, const std::string& file) {
  if (scene.space != Space::axisymmetric) return;
  const auto range = radial_range(mesh);
  if (range.low < -rounding * std::abs(range.high - range.low))
    throw InputError("a mesh has negative radii", radii(range.low, range.high),
                     "x = r >= 0, y = z in axisymmetric space", file);
}

void check_axis(const Scene& scene, const SimplexMesh<2>& mesh) {
  if (scene.space != Space::axisymmetric) return;
  const auto range = radial_range(mesh);
  const double small = rounding * (range.high - range.low);
  for (const auto& facet : mesh.boundary) {
    const auto &a = mesh.points[facet.points[0]], &b = mesh.points[facet.points[1]];
    const bool on_axis = std::abs(a[0]) <= small && std::abs(b[0]) <= small;
    const std::string& name = mesh.boundary_names[facet.tag];
    if (on_axis == (name == "axis")) continue;
    throw InputError(on_axis ? "a boundary on the axis of symmetry would be a wall"
                             : "a boundary named \"axis\" is not on the axis",
                     "physical group \"" + name + "\" at r = " + mm(0.5 * (a[0] + b[0])) +
                         " mm, z = " + mm(0.5 * (a[1] + b[1])) + " mm",
                     "the physical group \"axis\" for all of r = 0 and nothing else",
                     scene.fluid_mesh.string());
  }
}

} // namespace

double mesh_unit_length(const Scene& scene) {
  switch (scene.mesh_unit) {
    case MeshUnit::cm:
      return 1;
    case MeshUnit::mm:
      return 0.1;
    case MeshUnit::um:
      return 1e-4;
    case MeshUnit::m:
      return 100;
    case MeshUnit::inch:
      return 2.54;
  }
  return 1;
}

void check_clamp_radius(const Scene& scene, double inner, double outer, const std::string& what) {
  const double clamp = scene.clamp_radius;
  if (clamp >= inner * (1 - rounding) && clamp < outer) return;
  throw InputError(clamp < outer ? "the motion would be imposed on the whole membrane and beyond it"
                                 : "the motion would be imposed on nothing: the membrane floats",
                   "clamp_radius_mm = " + mm(clamp) + ", " + what + " " + radii(inner, outer),
                   "a radius on the membrane, in mm" +
                       std::string(scene.profile.empty()
                                       ? "; \"geometry.solid_meshes\" begin with the membrane, in units of "
                                         "\"geometry.mesh_unit\""
                                       : "; 0 for the radius in the profile"),
                   place_of_key(scene, "membrane.clamp_radius_mm", name_of(scene)));
}

void round_corners(const Scene& scene, PumpProfile& profile) {
  const auto round = [&](const std::string& key, double stated, double largest, double& radius) {
    if (stated <= 0) return;
    if (!corner_fits(stated, largest))
      throw InputError(
          "the membrane's corners cannot have this radius", key + " = " + mm(stated),
          "0 (as in the profile), or " + mm(smallest_corner_radius(largest)) + " to " + mm(largest),
          place_of_key(scene, "membrane." + key, name_of(scene)));
    radius = stated;
  };
  auto& membrane = profile.membrane;
  round("tip_radius_mm", scene.tip_radius, largest_tip_radius(membrane), membrane.tip_radius);
  round("rim_radius_mm", scene.rim_radius, largest_rim_radius(membrane), membrane.rim_radius);
}

PumpWork check_pump_work(const Scene& scene, const PumpProfile& profile) {
  const PumpMeshSizes sizes{scene.mesh.gap_elements, scene.mesh.channel_size, scene.mesh.membrane_size,
                            scene.mesh.growth};
  std::vector<std::string> keys = {"mesh.gap_elements", "mesh.channel_size_mm"};
  struct Box {
    RefinementBox<2> box;
    int source;
  };
  std::vector<Box> boxes;
  for (const auto& [name, box] : scene.problem.refinements) {
    boxes.push_back({{{box.box[0][0], box.box[0][1]}, {box.box[1][0], box.box[1][1]}, box.size},
                     static_cast<int>(keys.size())});
    keys.push_back("refine." + name + ".size_mm");
  }
  const auto by_gaps = pump_size_field(profile, sizes);
  const auto size_at = [&](const Point<2>& x) {
    SizeOfSource smallest = {by_gaps(x), 0};
    if (smallest.size >= sizes.channel_size) smallest.source = 1;
    for (const auto& [box, source] : boxes)
      if (const double size = size_about(box, sizes.growth, x); size < smallest.size)
        smallest = {size, source};
    return smallest;
  };
  constexpr double most = 100.0 * most_cells;
  const auto overlay = lay_over({polygon_sides(fluid_outline(profile).points)});
  const auto fluid =
      estimate_cells(overlay.pieces, size_at, sizes.growth, static_cast<int>(keys.size()), most);
  PumpWork work;
  work.fluid_cells = fluid.cells;
  const auto worst = std::max_element(fluid.by_source.begin(), fluid.by_source.end());
  std::string key = keys[static_cast<std::size_t>(worst - fluid.by_source.begin())];
  if (scene.space != Space::thin_gap) {
    const auto solids = lay_over(
        {polygon_sides(membrane_outline(profile.membrane).points), polygon_sides(profile.magnet.points)});
    for (const auto& piece : solids.pieces) {
      const bool membrane = solids.parts[piece.part].inside[0] != 0;
      const double growth = membrane ? 0.1 : 0.0; // the membrane's size follows its thickness
      const auto solid = [&](const Point<2>& x) {
        const double across = membrane ? 0.375 * membrane_thickness(profile.membrane, x[0]) : HUGE_VAL;
        return SizeOfSource{std::min(sizes.membrane_size, across), 0};
      };
      work.solid_cells += estimate_cells({&piece, 1}, solid, growth, 1, most).cells;
    }
    if (work.solid_cells > work.fluid_cells) key = "mesh.membrane_size_mm";
  }
  if (const double cells = work.fluid_cells + work.solid_cells; !(cells <= most_cells))
    throw InputError("the meshes would have too many cells",
                     "about " + plain_number(cells) + ", most of them by \"" + key + "\"" +
                         (key == "mesh.membrane_size_mm" ? " or the membrane's thickness" : ""),
                     "at most " + std::to_string(most_cells) + " in all",
                     place_of_key(scene, key, name_of(scene)));
  return work;
}

void check_imported_meshes(const Scene& scene, const SimplexMesh<2>& background,
                           const std::vector<SimplexMesh<2>>& solids) {
  check_radii(scene, background, scene.fluid_mesh.string());
  for (std::size_t s = 0; s < solids.size(); ++s)
    check_radii(scene, solids[s], scene.solid_meshes[s].string());
  check_axis(scene, background);

  OutlinedProblem outlined;
  outlined.where = scene.fluid_mesh.string();
  outlined.fluid = boundary_of(background);
  for (const auto& facet : background.boundary) outlined.side.push_back(facet.tag);
  for (const auto& name : background.boundary_names) {
    const bool open = name == inlet_name || name == outlet_name;
    outlined.sides.push_back(
        {name, open ? OutlinedSide::Kind::opening : OutlinedSide::Kind::closed, scene.fluid_mesh.string()});
  }
  for (const char* opening : {inlet_name, outlet_name}) {
    const bool there =
        std::any_of(background.boundary.begin(), background.boundary.end(),
                    [&](const auto& facet) { return background.boundary_names[facet.tag] == opening; });
    if (!there)
      throw InputError(
          "the fluid mesh has no opening",
          std::string("no boundary named '") + opening + "'; there are " + used_names(background),
          "physical groups 'inlet' and 'outlet' on the boundary", scene.fluid_mesh.string());
  }
  for (std::size_t s = 0; s < solids.size(); ++s)
    outlined.bodies.push_back({s == 0 ? "membrane" : "holder_" + std::to_string(s), boundary_of(solids[s]),
                               false, scene.solid_meshes[s].string()});
  check_outlines(outlined, [](const std::vector<int>&) { return 0.0; });
}

std::vector<std::string> profile_differences(const Scene& scene) {
  std::vector<std::string> sentences;
  if (scene.profile.empty()) return sentences;
  const PumpProfile profile = read_pump_profile(scene.profile);
  const std::pair<const char*, std::pair<const char*, double>> counterparts[] = {
      {"materials.fluid.density", {"fluid.density_g_per_cm3", scene.fluid.density}},
      {"materials.fluid.viscosity", {"fluid.viscosity_poise", scene.fluid.viscosity}},
      {"materials.membrane.density", {"membrane.density_g_per_cm3", scene.membrane.density}},
      {"materials.membrane.young", {"membrane.young_dyn_per_cm2", scene.membrane.young}},
      {"materials.membrane.poisson", {"membrane.poisson", scene.membrane.poisson}}};
  for (const auto& stated : profile.materials)
    for (const auto& [key, counterpart] : counterparts) {
      const auto& [scene_key, value] = counterpart;
      if (stated.key == key && std::abs(stated.value - value) > rounding * std::abs(value))
        sentences.push_back(profile.file.string() + ":" + std::to_string(stated.line) + " states " +
                            stated.key + " = " + plain_number(stated.value) + "; what counts is " +
                            scene_key + " = " + plain_number(value) + " of the scene");
    }
  if (scene.space == Space::thin_gap && (profile.membrane.tip_radius > 0 || profile.membrane.rim_radius > 0))
    sentences.push_back(profile.file.string() +
                        " rounds the membrane's corners, which thin gaps do not know");
  return sentences;
}

} // namespace undula::fom
