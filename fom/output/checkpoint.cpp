#include "fom/output/checkpoint.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"

namespace undula::fom {
namespace {

constexpr const char* format = "undula checkpoint 1";
constexpr std::string_view prefix = "checkpoint_", suffix = ".h5";

/// Step in the name of a checkpoint, -1 for other files.
int step_of(const std::filesystem::path& file) {
  const auto name = file.filename().string();
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return -1;
  int step = -1;
  const char* end = name.data() + name.size() - suffix.size();
  const auto parsed = std::from_chars(name.data() + prefix.size(), end, step);
  return parsed.ec == std::errc() && parsed.ptr == end ? step : -1;
}

/// Checkpoints of a folder by rising step.
std::vector<std::pair<int, std::filesystem::path>> checkpoints_in(const std::filesystem::path& folder) {
  std::vector<std::pair<int, std::filesystem::path>> found;
  if (!std::filesystem::is_directory(folder)) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const int step = step_of(entry.path()); step >= 0) found.emplace_back(step, entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

void remove_old(const std::filesystem::path& folder, int newest_step) {
  auto found = checkpoints_in(folder);
  // Later ones belong to a run that was set back to an earlier checkpoint.
  std::erase_if(
      found, [&](const auto& one) { return one.first > newest_step && std::filesystem::remove(one.second); });
  for (std::size_t k = 0; k + 2 < found.size(); ++k) std::filesystem::remove(found[k].second);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(".partial")) std::filesystem::remove(entry.path());
  }
}

} // namespace

std::filesystem::path save_checkpoint(const Checkpoint& state, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto target = folder / (std::string(prefix) + std::to_string(state.step) + std::string(suffix));
  auto file = Hdf5File::create(target);
  file.write_attribute("/", "format", format);
  file.write_attribute("/", "step", state.step);
  file.write_attribute("/", "time", state.time);
  file.write_attribute("/", "scene_hash", state.scene.hash);
  file.write_text("scene", state.scene.text);
  for (const auto* group : {"scalars", "arrays", "provenance"}) file.create_group(group);
  for (const auto& [name, value] : state.scalars) file.write("scalars/" + name, std::span(&value, 1), {});
  for (const auto& [name, values] : state.arrays) file.write("arrays/" + name, std::span(values));
  for (const auto& [name, text] : state.provenance) file.write_text("provenance/" + name, text);
  file.commit();
  remove_old(folder, state.step);
  return target;
}

Checkpoint load_checkpoint(const std::filesystem::path& path, const SceneStamp& scene) {
  const auto file = Hdf5File::open_read(path);
  const auto seen =
      file.has_attribute("/", "format") ? file.read_attribute<std::string>("/", "format") : "none";
  if (seen != format) throw InputError("not a checkpoint", "format: " + seen, format, path.string());
  Checkpoint state;
  state.scene = {file.read_attribute<std::string>("/", "scene_hash"), file.read_text("scene")};
  if (state.scene.hash != scene.hash)
    throw InputError("the checkpoint belongs to another scene", "scene hash " + state.scene.hash,
                     "scene hash " + scene.hash + " (compare the dataset 'scene' with `undula check`)",
                     path.string());
  state.step = file.read_attribute<int>("/", "step");
  state.time = file.read_attribute<double>("/", "time");
  for (const auto& name : file.children("scalars"))
    state.scalars[name] = file.read<double>("scalars/" + name, {}).front();
  for (const auto& name : file.children("arrays")) state.arrays[name] = file.read<double>("arrays/" + name);
  for (const auto& name : file.children("provenance"))
    state.provenance[name] = file.read_text("provenance/" + name);
  return state;
}

std::optional<std::filesystem::path> newest_checkpoint(const std::filesystem::path& folder) {
  const auto found = checkpoints_in(folder);
  if (found.empty()) return std::nullopt;
  return found.back().second;
}

} // namespace undula::fom
