#include "fom/output/run_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "fom/output/checkpoint.hpp"
#include "rom/base/error.hpp"
#include "rom/base/replaced_file.hpp"

namespace undula::fom {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> tables = {"time_series.csv", "wall_shear.csv",   "membrane.csv",
                                                    "cycle_means.csv", "envelope.csv",     "statistics.csv",
                                                    "timing.json",     resolved_scene_name};
constexpr std::array<std::string_view, 2> field_series = {"fluid", "solids"};
constexpr std::array<std::string_view, 10> pictures = {
    "speed",  "pressure",   "speed_gap", "membrane",        "flow",
    "holder", "wall_shear", "torque",    "outlet_pressure", "roller_force"};
constexpr std::array<std::string_view, 4> picture_endings = {".png", ".gp", ".dat", ".png.tmp"};
constexpr std::string_view partial = ".partial";

bool all_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// `text` without `end`, empty unless it ends so.
std::string_view without_end(std::string_view text, std::string_view end) {
  return text.ends_with(end) ? text.substr(0, text.size() - end.size()) : std::string_view();
}

/// "time_series.csv" of "time_series.csv.4711.0.partial"; other names as they are.
std::string_view target_of(std::string_view name) {
  auto target = without_end(name, partial);
  if (target.empty()) return name;
  for (auto dot = target.rfind('.'); dot != std::string_view::npos && all_digits(target.substr(dot + 1));
       dot = target.rfind('.'))
    target = target.substr(0, dot);
  return target;
}

bool is_field_file(std::string_view name) {
  return std::any_of(field_series.begin(), field_series.end(), [&](std::string_view series) {
    if (!name.starts_with(series)) return false;
    const auto rest = name.substr(series.size());
    if (rest == ".xdmf" || rest == "_mesh.h5") return true;
    return rest.starts_with('_') && all_digits(without_end(rest.substr(1), ".h5"));
  });
}

bool is_picture_file(std::string_view name) {
  return std::any_of(pictures.begin(), pictures.end(), [&](std::string_view picture) {
    return name.starts_with(picture) && std::find(picture_endings.begin(), picture_endings.end(),
                                                  name.substr(picture.size())) != picture_endings.end();
  });
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

bool is_run_file(std::string_view name) {
  const auto target = target_of(name);
  return std::find(tables.begin(), tables.end(), target) != tables.end() || is_field_file(target) ||
         is_picture_file(target);
}

fs::path checkpoint_folder(const fs::path& run) { return run / "checkpoints"; }

std::vector<fs::path> run_files(const fs::path& folder) {
  std::vector<fs::path> files;
  const auto checkpoints = checkpoint_folder(folder);
  for (const auto& name : names_in(checkpoints))
    if (checkpoint_step(target_of(name)) >= 0) files.push_back(checkpoints / name);
  for (const auto& name : names_in(folder))
    if (is_run_file(name) && name != resolved_scene_name) files.push_back(folder / name);
  if (fs::exists(folder / resolved_scene_name)) files.push_back(folder / resolved_scene_name);
  return files;
}

void remove_run(const fs::path& folder) {
  const auto files = run_files(folder);
  for (const auto& file : files) {
    const bool removable = ::access(file.parent_path().c_str(), W_OK) == 0;
    if (!removable || fs::is_directory(fs::symlink_status(file)))
      throw InputError(
          "the run in the folder cannot be replaced; all of it is kept",
          "\"" + file.filename().string() + "\"" + (removable ? ", a folder" : " cannot be removed"),
          "files that may be removed, or another folder", folder.string());
  }
  // The stamp is last in the list: were this stopped half-way, the folder would still be known as a run's.
  for (const auto& file : files) fs::remove(file);
  std::error_code other_files_in_it;
  fs::remove(checkpoint_folder(folder), other_files_in_it);
}

void remove_unfinished(const fs::path& folder) {
  for (const auto& file : run_files(folder))
    if (file.extension() == partial) remove_leftover(file);
}

} // namespace undula::fom
