#include "fom/levels/moving_reduced_level.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

#include "fom/levels/marched_curve.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/error_estimate.hpp"
#include "rom/curve/hq_curve.hpp"

namespace undula::fom {
namespace {

/// The model's profile as a file, as long as this lives: scenes name files.
class ProfileFile {
public:
  explicit ProfileFile(const std::string& text) {
    static std::atomic<int> count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("undula-profile-" + std::to_string(::getpid()) + "-" + std::to_string(++count) + ".toml");
    std::ofstream file(path_);
    file << text;
    file.close();
    if (file) return;
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    throw InputError("the profile of a model cannot be written", "an error of the file system",
                     "a writable folder for temporary files (TMPDIR)", path_.string());
  }
  ~ProfileFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ProfileFile(const ProfileFile&) = delete;
  ProfileFile& operator=(const ProfileFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

Scene whole_scene(const rom::MovingModel& model, const std::string& file, const ProfileFile& profile) {
  const std::vector<std::string> overrides{"geometry.profile=\"" + profile.path().string() + "\""};
  return parse_scene(model.scene, file, std::filesystem::temp_directory_path(), overrides);
}

} // namespace

Scene scene_of_moving_model(const rom::MovingModel& model, const std::string& file, double frequency_Hz,
                            const rom::StatedDrive& drive) {
  const double voltage = rom::drive_of(drive, true, "the model", file);
  if (!(frequency_Hz > 0) || !std::isfinite(frequency_Hz))
    throw InputError("no operating point: frequency (Hz)", plain_number(frequency_Hz), "a finite number > 0",
                     file);
  const ProfileFile profile(model.profile);
  Scene scene = whole_scene(model, file, profile);
  scene.operating_point.frequency = frequency_Hz;
  scene.operating_point.voltage = voltage;
  scene.operating_point.head =
      units::pressure_from_mmHg((model.box.head_low_mmHg + model.box.head_high_mmHg) / 2);
  scene.profile.clear();
  return scene;
}

std::unique_ptr<FiniteElementLevel> reduced_march(const rom::MovingModel& model, const std::string& file,
                                                  MPI_Comm comm, PhaseTimer& timer) {
  // Preparing is collective: all ranks have their profile, or none goes on.
  std::optional<ProfileFile> written;
  std::string why;
  try {
    written.emplace(model.profile);
  } catch (const InputError& error) {
    why = error.what();
  }
  int all = written ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm);
  if (all == 0)
    throw InputError("the profile of a model cannot be written", why.empty() ? "on another rank" : why,
                     "a writable folder for temporary files (TMPDIR)", file);
  const ProfileFile& profile = *written;
  auto level = std::make_unique<FiniteElementLevel>(whole_scene(model, file, profile), comm, timer);
  const auto& disc = level->prepared().disc;
  std::size_t cells = 0;
  for (const auto& space : disc.solid_spaces) cells += space.cell_nodes.size();
  const auto check = [&](const char* what, std::size_t seen, std::size_t allowed) {
    if (seen != allowed)
      throw InputError(std::string("the model does not fit the mesh of its scene: ") + what,
                       std::to_string(seen),
                       std::to_string(allowed) + "; another version of a library may mesh differently", file);
  };
  check("unknowns", static_cast<std::size_t>(model.basis.rows()), static_cast<std::size_t>(disc.unknowns()));
  if (!model.part_weights.empty()) check("parts", model.part_weights.size(), disc.cut.parts.size());
  if (!model.cell_weights.empty()) check("cells of solids", model.cell_weights.size(), cells);
  auto space = std::make_shared<ReducedSpace>();
  space->basis = model.basis;
  space->part_weights = model.part_weights;
  space->cell_weights = model.cell_weights;
  level->reduce(std::move(space), timer);
  return level;
}

MovingReducedLevel::MovingReducedLevel(const rom::MovingModel& model, const std::string& file, MPI_Comm comm,
                                       PhaseTimer& timer)
    : march_(reduced_march(model, file, comm, timer)),
      box_(model.box),
      error_l_per_min_(model.error_l_per_min),
      modes_(static_cast<int>(model.basis.cols())) {}

std::vector<CurvePoint> MovingReducedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                                  const std::function<void()>& on_point) {
  /// From the state at another head: what is left of it then is a smaller jump than a start.
  constexpr int periods_between_heads = 6;
  std::vector<CurvePoint> points;
  State state = march_->initial_state();
  bool at_rest = true;
  for (const double head : heads_mmHg) {
    Scene at_head = scene;
    at_head.operating_point.head = units::pressure_from_mmHg(head);
    if (!at_rest) at_head.time.periods = std::min(scene.time.periods, periods_between_heads);
    const auto run = march_until_periodic(*march_, at_head, state);
    points.push_back(curve_point(run, head));
    CurvePoint& point = points.back();
    const auto& at = scene.operating_point;
    point.inside_training_box = rom::growth_outside_box(box_, at.frequency, at.voltage, head) == 1;
    // The runs tell of the box alone; what the march does not know of its own mean comes on top.
    const double own = point.periodic ? 0.0 : point.standard_error_l_per_min;
    point.error_l_per_min = *point.inside_training_box && std::isfinite(own)
                                ? error_l_per_min_ + own
                                : std::numeric_limits<double>::infinity();
    at_rest = run.state == RunState::failed;
    if (at_rest) state = march_->initial_state();
    if (on_point) on_point();
  }
  return points;
}

std::vector<std::string> MovingReducedLevel::remarks(const Scene& scene,
                                                     std::span<const double> heads_mmHg) const {
  const auto& at = scene.operating_point;
  return rom::outside_training_box(box_, at.frequency, at.voltage, heads_mmHg, {"voltage", "V"});
}

} // namespace undula::fom
