#include "fom/output/checkpoint.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"

namespace undula::fom {
namespace {

constexpr FileFormat file_format{"undula checkpoint", "a checkpoint", 2};
constexpr std::string_view prefix = "checkpoint_", suffix = ".h5";
constexpr std::size_t kept = 2;

void remove_old(const std::filesystem::path& folder, int newest_step) {
  std::size_t seen = 0;
  for (const auto& one : stored_checkpoints(folder))
    // Later ones belong to a run that was set back to an earlier checkpoint.
    if (one.step > newest_step || ++seen > kept) std::filesystem::remove(one.file);
}

} // namespace

int checkpoint_step(std::string_view name) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size())
    return -1;
  int step = -1;
  const char* end = name.data() + name.size() - suffix.size();
  const auto parsed = std::from_chars(name.data() + prefix.size(), end, step);
  return parsed.ec == std::errc() && parsed.ptr == end ? step : -1;
}

std::vector<StoredCheckpoint> stored_checkpoints(const std::filesystem::path& folder) {
  std::vector<StoredCheckpoint> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (const int step = checkpoint_step(entry.path().filename().string()); step >= 0)
      found.push_back({step, entry.path()});
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.step > b.step; });
  return found;
}

std::filesystem::path save_checkpoint(const Checkpoint& state, const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw NumericsError("cannot create the folder of the checkpoints: " + failure.message(), folder.string(),
                        "free space on the disk; a name that is not taken by a file");
  const auto target = folder / (std::string(prefix) + std::to_string(state.step) + std::string(suffix));
  auto file = Hdf5File::create(target);
  file.write_attribute("/", "format", format_text(file_format));
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
  const auto file = Hdf5File::open_sealed(path);
  checked_version(file, file_format);
  Checkpoint state;
  state.scene = {file.read_attribute<std::string>("/", "scene_hash"), file.read_text("scene")};
  if (state.scene.hash != scene.hash)
    throw InputError("the checkpoint belongs to another scene", "scene hash " + state.scene.hash,
                     "scene hash " + scene.hash + " (compare the dataset 'scene' with `undula check`)",
                     path.string());
  state.step = file.read_attribute<int>("/", "step");
  if (state.step != checkpoint_step(path.filename().string()))
    throw InputError("the checkpoint has the name of another step", "step " + std::to_string(state.step),
                     "the step in its name", path.string());
  state.time = file.read_attribute<double>("/", "time");
  for (const auto& name : file.children("scalars"))
    state.scalars[name] = file.read<double>("scalars/" + name, {}).front();
  for (const auto& name : file.children("arrays")) state.arrays[name] = file.read<double>("arrays/" + name);
  for (const auto& name : file.children("provenance"))
    state.provenance[name] = file.read_text("provenance/" + name);
  return state;
}

std::optional<std::filesystem::path> newest_checkpoint(const std::filesystem::path& folder) {
  const auto found = stored_checkpoints(folder);
  if (found.empty()) return std::nullopt;
  return found.front().file;
}

} // namespace undula::fom
