// The full-order model as a function of the head.
#pragma once

#include <mpi.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/validation.hpp"
#include "fom/levels/level.hpp"

namespace undula::apps {

/// Whether a file is a scene, by its ending (.toml in any case), rather than a model.
bool is_scene_file(const std::string& file);

/// Logs what the profile of a scene states otherwise than the scene.
void warn_of_profile(const Scene& scene);

/// Reads a scene with `--set` overrides, then `--frequency` and `--stroke` where they are given.
Scene read_scene_at(const std::string& file, std::vector<std::string> overrides,
                    const std::optional<double>& frequency_Hz, const std::optional<double>& stroke_mm);

/// Runs the scene from rest at each head, on a level prepared once, and takes the mean outflow of its last
/// period. `level` and `on_step` (called after every step) must outlive the function. Calls are collective
/// and throw NumericsError on every rank.
FlowAtHead flow_of_scene(PreparedLevel& level, const Scene& scene, const std::function<void()>& on_step);

} // namespace undula::apps
