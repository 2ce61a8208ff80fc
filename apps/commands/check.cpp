// undula check scene.toml: validates everything, meshes and cuts, solves nothing.
//   undula check data/scenes/wave_pump_fixed.toml
//   undula check data/scenes/wave_pump_thin_gap.toml
//   undula check data/scenes/wave_pump_fixed.toml --set operating_point.head_mmHg=55 --json
//   undula check --reference > docs/scene.md
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/scene_check.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/hose_report.hpp"
#include "apps/output/text_table.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool reference = false;
  bool json = false;
};

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
    passage_rows.push_back({name, plain_number(passage->inertance), plain_number(passage->resistance),
                            plain_number(passage->area)});
  }
  return text_table({"node", "radius (mm)", "plate (mm)", "gap above (mm)", "gap below (mm)"}, rows) + "\n" +
         text_table({"passage", "inertance (1/cm)", "resistance (1/cm^3)", "area (cm^2)"}, passage_rows) +
         "\n" + std::to_string(layout.radius.size()) + " nodes, " +
         decimals(units::length_to_mm(layout.step), 3) + " mm apart; holder area " +
         plain_number(layout.holder_area) + " cm^2\n";
}

nlohmann::ordered_json point_in_mm(const Point<2>& x) {
  return {units::length_to_mm(x[0]), units::length_to_mm(x[1])};
}

void print_json(const Scene& scene, const SceneCheck& check) {
  nlohmann::ordered_json result = {{"scene", scene.name},
                                   {"hash", scene_hash(scene)},
                                   {"estimated_cells", std::round(check.estimated_cells)},
                                   {"unknowns", check.unknowns},
                                   {"steps", check.steps},
                                   {"walls", check.walls},
                                   {"notes", check.notes}};
  for (const auto& mesh : check.meshes) {
    nlohmann::ordered_json entry = {{"name", mesh.name},
                                    {"cells", mesh.quality.cells},
                                    {"points", mesh.quality.points},
                                    {"min_angle_deg", mesh.quality.min_angle},
                                    {"shortest_edge_cm", mesh.quality.shortest_edge},
                                    {"longest_edge_cm", mesh.quality.longest_edge},
                                    {"low_mm", point_in_mm(mesh.box.low)},
                                    {"high_mm", point_in_mm(mesh.box.high)}};
    if (!mesh.file.empty()) {
      entry["file"] = mesh.file;
      entry["reoriented_cells"] = mesh.reoriented;
    }
    result["meshes"].push_back(std::move(entry));
  }
  for (const CheckedWeight& weight : check.weights) {
    result["stabilisation"].push_back(
        {{"key", weight.key}, {"value", weight.value}, {"origin", weight.origin}});
  }
  if (check.thin_gap) {
    result["thin_gap"] = layout_json(*check.thin_gap);
  }
  if (check.hose) {
    result["hose"] = hose_json(*check.hose);
  }
  result["resolved"] = scene_to_toml(scene);
  std::cout << result.dump(2) << "\n";
}

std::string mesh_tables(const Scene& scene, const std::vector<CheckedMesh>& meshes) {
  const bool axisymmetric = scene.space == Space::axisymmetric;
  const bool imported = !scene.fluid_mesh.empty();
  const auto range = [](double low, double high) {
    return decimals(units::length_to_mm(low), 3) + " to " + decimals(units::length_to_mm(high), 3);
  };
  std::vector<std::vector<std::string>> rows, places;
  for (const auto& mesh : meshes) {
    const MeshQuality& quality = mesh.quality;
    rows.push_back({mesh.name, std::to_string(quality.cells), std::to_string(quality.points),
                    decimals(quality.min_angle, 1), decimals(quality.shortest_edge, 4),
                    decimals(quality.longest_edge, 4)});
    places.push_back(
        {mesh.name, range(mesh.box.low[0], mesh.box.high[0]), range(mesh.box.low[1], mesh.box.high[1])});
    if (imported) {
      places.back().push_back(mesh.file);
      places.back().push_back(std::to_string(mesh.reoriented));
    }
  }
  std::vector<std::string> header = {"mesh", axisymmetric ? "r (mm)" : "x (mm)",
                                     axisymmetric ? "z (mm)" : "y (mm)"};
  if (imported) {
    header.insert(header.end(), {"file", "cells turned round"});
  }
  return text_table({"mesh", "cells", "points", "min angle (deg)", "shortest edge (cm)", "longest edge (cm)"},
                    rows) +
         "\n" + text_table(header, places);
}

std::string weights_table(const std::vector<CheckedWeight>& weights) {
  std::vector<std::vector<std::string>> rows;
  for (const CheckedWeight& weight : weights) {
    rows.push_back({weight.key, weight.value, weight.origin});
  }
  return weights.empty() ? "" : text_table({"stabilisation", "in force", "origin"}, rows) + "\n";
}

std::string closing_lines(const SceneCheck& check) {
  std::string text;
  std::string walls;
  for (const std::string& name : check.walls) {
    walls += (walls.empty() ? "" : ", ") + name;
  }
  if (!walls.empty()) {
    text += "walls: " + walls + "\n";
  }
  for (const std::string& note : check.notes) {
    text += "note: " + note + "\n";
  }
  if (check.estimated_cells > 0) {
    text += "about " + decimals(check.estimated_cells, 0) + " cells by the sizes asked for\n";
  }
  return text + std::to_string(check.unknowns) + " unknowns per step, " + std::to_string(check.steps) +
         " steps\n";
}

void print_text(const Scene& scene, const SceneCheck& check) {
  std::cout << scene_to_toml(scene) << "\n"
            << (check.hose       ? hose_table(*check.hose)
                : check.thin_gap ? layout_tables(*check.thin_gap)
                                 : mesh_tables(scene, check.meshes))
            << "\n"
            << weights_table(check.weights) << closing_lines(check) << "\nscene " << scene.name
            << " is valid, hash " << scene_hash(scene) << "\n";
}

void check(const CheckOptions& options) {
  if (!is_first_process()) {
    return;
  }
  if (options.reference) {
    std::cout << scene_reference();
    return;
  }
  // 1. Keys, types, ranges, contradictions, outlines.
  const Scene scene = read_scene(options.scene, options.overrides);

  // 2. Profile, meshes and cut, or what thin gaps derive from the profile.
  const SceneCheck found = check_scene(scene);

  // 3. What a run would use.
  if (options.json) {
    print_json(scene, found);
  } else {
    print_text(scene, found);
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
