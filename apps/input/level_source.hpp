// What a command is asked about: a scene (.toml), a reduced model or an emulator (.h5), behind one door.
#pragma once

#include <mpi.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/levels/level.hpp"
#include "rom/emulator/emulator.hpp"
#include "rom/fixed_domain/model.hpp"
#include "rom/moving_domain/moving_model.hpp"

namespace undula::apps {

/// A file and what is stated beside it on the command line.
struct LevelSource {
  std::string file;
  Scene scene;                            ///< of a model: scene_of_model, scene_of_emulator
  std::optional<rom::Model> model;        ///< nothing for a scene
  std::optional<rom::Emulator> emulator;  ///< the same
  std::optional<rom::MovingModel> moving; ///< the same

  [[nodiscard]] bool is_model() const { return model || emulator || moving; }
};

/// Whether a file is read as a scene, by its ending (.toml in any case).
bool is_scene(const std::string& file);

/// Logs what the profile of a scene states otherwise than the scene.
void warn_of_profile(const Scene& scene);

/// Reads a scene of a pump with `--set` overrides, then `--frequency`, `--stroke` and `--voltage` (which
/// drives the actuator of the scene) where they are given; or
/// a reduced model or an emulator, which need frequency and drive; an emulator's keys to override are those
/// that it answers for, a reduced model has none. Throws
/// InputError (or CLI::RequiredError for a missing frequency or stroke) for anything else.
LevelSource read_level_source(const std::string& file, std::vector<std::string> overrides,
                              const std::optional<double>& frequency_Hz,
                              const std::optional<double>& stroke_mm,
                              const std::optional<double>& voltage_V = {});

/// The level of a source. Phases as prepare_level. Collective over `comm`.
std::unique_ptr<Level> prepare(const LevelSource& source, MPI_Comm comm, PhaseTimer& timer);

} // namespace undula::apps
