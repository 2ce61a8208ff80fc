// undula check scene.toml: validates everything, solves nothing.
//   undula check data/scenes/wave_pump_fixed.toml
//   undula check data/scenes/wave_pump_thin_gap.toml
//   undula check data/scenes/wave_pump_fixed.toml --set operating_point.head_mmHg=55 --json
//   undula check --reference > docs/scene.md
#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/output/text_table.hpp"
#include "fom/levels/scene_problem.hpp"
#include "fom/scene/scene_checks.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "fom/thin_gap/thin_gap.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool reference = false;
  bool json = false;
};

struct NamedMesh {
  std::string name;
  MeshQuality quality;
};

/// Meshes the profile, or reads the meshes, of a scene; throws InputError for what is wrong with them.
std::vector<NamedMesh> check_meshes(const Scene& scene) {
  const FsiProblem<2> problem = scene_problem(scene);
  std::vector<NamedMesh> meshes = {{"background", mesh_quality(problem.background)}};
  for (const SolidBody<2>& solid : problem.solids) {
    meshes.push_back({solid.name, mesh_quality(solid.mesh)});
  }
  return meshes;
}

/// What the check of a scene found: meshes, or the coefficients of the thin gaps.
struct CheckedGeometry {
  std::vector<NamedMesh> meshes;
  std::optional<ThinGapLayout> thin_gap;
};

CheckedGeometry check_geometry(const Scene& scene) {
  if (scene.space == Space::thin_gap) {
    PhaseTimer timer;
    return {{}, prepare_thin_gap(scene, timer).layout};
  }
  return {check_meshes(scene), std::nullopt};
}

std::vector<double> in_mm(const std::vector<double>& lengths) {
  std::vector<double> result;
  for (const double length : lengths) {
    result.push_back(units::length_to_mm(length));
  }
  return result;
}

std::array<std::pair<const char*, const Passage*>, 3> passages(const ThinGapLayout& layout) {
  return {{{"inlet", &layout.inlet}, {"rim", &layout.rim}, {"outlet", &layout.outlet}}};
}

nlohmann::ordered_json layout_json(const ThinGapLayout& layout) {
  nlohmann::ordered_json result = {{"radius_mm", in_mm(layout.radius)},
                                   {"thickness_mm", in_mm(layout.thickness)},
                                   {"upper_height_mm", in_mm(layout.upper_height)},
                                   {"lower_height_mm", in_mm(layout.lower_height)},
                                   {"clamp_node", layout.clamp},
                                   {"channel_node", layout.channel},
                                   {"lip_node", layout.lip},
                                   {"holder_area_cm2", layout.holder_area},
                                   {"passages", nlohmann::ordered_json::array()}};
  for (const auto& [name, passage] : passages(layout)) {
    result["passages"].push_back({{"name", name},
                                  {"inertance_per_cm", passage->inertance},
                                  {"resistance_per_cm3", passage->resistance},
                                  {"area_cm2", passage->area}});
  }
  return result;
}

/// Heights at a few nodes, the ones where parts begin among them, and the passages.
std::string layout_tables(const ThinGapLayout& layout) {
  const int last = static_cast<int>(layout.radius.size()) - 1;
  std::map<int, std::string> shown = {{0, "tip"}, {last, "rim"}};
  for (int quarter = 1; quarter < 4; ++quarter) {
    shown.emplace(quarter * last / 4, "");
  }
  for (const auto& [node, name] : {std::pair(layout.lip, "lip"), std::pair(layout.channel, "channel"),
                                   std::pair(layout.clamp, "clamp")}) {
    if (node >= 0 && node <= last) {
      std::string& text = shown[node];
      text += (text.empty() ? "" : ", ") + std::string(name);
    }
  }
  // No gap lies above the holder: the inlet's channel does.
  const auto height = [&](const std::vector<double>& heights, int node) {
    return static_cast<std::size_t>(node) < heights.size()
               ? decimals(units::length_to_mm(heights[static_cast<std::size_t>(node)]), 3)
               : std::string("-");
  };
  std::vector<std::vector<std::string>> rows;
  for (const auto& [node, name] : shown) {
    rows.push_back({name.empty() ? "-" : name, height(layout.radius, node), height(layout.thickness, node),
                    height(layout.upper_height, node), height(layout.lower_height, node)});
  }
  std::vector<std::vector<std::string>> passage_rows;
  for (const auto& [name, passage] : passages(layout)) {
    passage_rows.push_back(
        {name, shortest(passage->inertance), shortest(passage->resistance), shortest(passage->area)});
  }
  return text_table({"node", "radius (mm)", "plate (mm)", "gap above (mm)", "gap below (mm)"}, rows) + "\n" +
         text_table({"passage", "inertance (1/cm)", "resistance (1/cm^3)", "area (cm^2)"}, passage_rows) +
         "\n" + std::to_string(layout.radius.size()) + " nodes, " +
         decimals(units::length_to_mm(layout.step), 3) + " mm apart; holder area " +
         shortest(layout.holder_area) + " cm^2\n";
}

void print_json(const Scene& scene, const CheckedGeometry& geometry) {
  nlohmann::ordered_json result = {{"scene", scene.name}, {"hash", scene_hash(scene)}};
  for (const auto& [name, quality] : geometry.meshes) {
    result["meshes"].push_back({{"name", name},
                                {"cells", quality.cells},
                                {"points", quality.points},
                                {"min_angle_deg", quality.min_angle},
                                {"shortest_edge_cm", quality.shortest_edge},
                                {"longest_edge_cm", quality.longest_edge}});
  }
  if (geometry.thin_gap) {
    result["thin_gap"] = layout_json(*geometry.thin_gap);
  }
  result["resolved"] = scene_to_toml(scene);
  std::cout << result.dump(2) << "\n";
}

std::string mesh_table(const std::vector<NamedMesh>& meshes) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, quality] : meshes) {
    rows.push_back({name, std::to_string(quality.cells), std::to_string(quality.points),
                    decimals(quality.min_angle, 1), decimals(quality.shortest_edge, 4),
                    decimals(quality.longest_edge, 4)});
  }
  return text_table({"mesh", "cells", "points", "min angle (deg)", "shortest edge (cm)", "longest edge (cm)"},
                    rows);
}

void print_text(const Scene& scene, const CheckedGeometry& geometry) {
  std::cout << scene_to_toml(scene) << "\n"
            << (geometry.thin_gap ? layout_tables(*geometry.thin_gap) : mesh_table(geometry.meshes))
            << "\nscene " << scene.name << " is valid, hash " << scene_hash(scene) << "\n";
}

void check(const CheckOptions& options) {
  if (options.reference) {
    std::cout << scene_reference();
    return;
  }
  // 1. Keys, types, ranges, contradictions.
  const Scene scene = read_scene(options.scene, options.overrides);
  if (scene.training.stated) {
    check_training(scene, options.scene);
  }

  // 2. Profile and meshes, or what thin gaps derive from the profile.
  const CheckedGeometry geometry = check_geometry(scene);

  // 3. What a run would use.
  if (options.json) {
    print_json(scene, geometry);
  } else {
    print_text(scene, geometry);
  }
}

} // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a scene, its profile and its meshes; solve nothing");
  CLI::Option* reference = command->add_flag("--reference", options->reference,
                                             "print the reference of all scene keys (docs/scene.md)");
  command->add_option("scene", options->scene, "scene file (TOML)")->excludes(reference);
  command->add_option("--set", options->overrides, "override a key: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "print JSON");
  command->footer(scene_keys_help());
  command->callback([options] {
    if (options->scene.empty() && !options->reference) {
      throw CLI::RequiredError("scene");
    }
    check(*options);
  });
}

} // namespace undula::apps
