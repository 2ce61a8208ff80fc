// undula check scene.toml: validates everything, solves nothing.
//   undula check data/scenes/wave_pump_fixed.toml
//   undula check data/scenes/wave_pump_fixed.toml --set operating_point.head_mmHg=55 --json
//   undula check --reference > docs/scene.md
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/text_table.hpp"
#include "fom/pump_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "geometry/mesh_quality.hpp"

namespace undula {
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
  const FsiProblem<2> problem = pump_problem(scene);
  std::vector<NamedMesh> meshes = {{"background", mesh_quality(problem.background)}};
  for (const SolidBody<2>& solid : problem.solids) {
    meshes.push_back({solid.name, mesh_quality(solid.mesh)});
  }
  return meshes;
}

void print_json(const Scene& scene, const std::vector<NamedMesh>& meshes) {
  nlohmann::ordered_json result = {{"scene", scene.name}, {"hash", scene_hash(scene)}};
  for (const auto& [name, quality] : meshes) {
    result["meshes"].push_back({{"name", name},
                                {"cells", quality.cells},
                                {"points", quality.points},
                                {"min_angle_deg", quality.min_angle},
                                {"shortest_edge_cm", quality.shortest_edge},
                                {"longest_edge_cm", quality.longest_edge}});
  }
  result["resolved"] = scene_to_toml(scene);
  std::cout << result.dump(2) << "\n";
}

void print_text(const Scene& scene, const std::vector<NamedMesh>& meshes) {
  std::cout << scene_to_toml(scene) << "\n";
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, quality] : meshes) {
    rows.push_back({name, std::to_string(quality.cells), std::to_string(quality.points),
                    decimals(quality.min_angle, 1), decimals(quality.shortest_edge, 4),
                    decimals(quality.longest_edge, 4)});
  }
  std::cout << text_table(
                   {"mesh", "cells", "points", "min angle (deg)", "shortest edge (cm)", "longest edge (cm)"},
                   rows)
            << "\nscene " << scene.name << " is valid, hash " << scene_hash(scene) << "\n";
}

void check(const CheckOptions& options) {
  if (options.reference) {
    std::cout << scene_reference();
    return;
  }
  // 1. Keys, types, ranges, contradictions.
  const Scene scene = read_scene(options.scene, options.overrides);

  // 2. Profile and meshes.
  const std::vector<NamedMesh> meshes = check_meshes(scene);

  // 3. What a run would use.
  if (options.json) {
    print_json(scene, meshes);
  } else {
    print_text(scene, meshes);
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

} // namespace undula
