// One model of the explorer: what it can be asked, and its answers as numbers.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/level_source.hpp"
#include "rom/curve/pump_period.hpp"

namespace undula::apps {

class ExploredModel {
public:
  /// Reads a reduced model of a fixed domain or an emulator. Throws InputError for other files.
  explicit ExploredModel(const std::string& file);

  [[nodiscard]] const std::string& file() const { return source_.file; }
  [[nodiscard]] bool by_voltage() const { return source_.emulator && source_.emulator->driven_by_voltage; }
  [[nodiscard]] rom::TrainingBox box() const;

  /// Name, level, drive, ranges of frequency, drive and head, the fluid of its runs (null where the file does
  /// not tell), and why there is no period or no scene ("" where there is).
  [[nodiscard]] nlohmann::ordered_json description() const;

  /// May be called from several threads.
  [[nodiscard]] Level& level() const { return *level_; }

  /// A scene at an operating point. Throws InputError for numbers that are none.
  [[nodiscard]] Scene scene_of(double frequency_Hz, double drive) const;

  /// Throws InputError for what lies outside of the box: the page never extrapolates.
  void require_inside(double frequency_Hz, double drive, std::span<const double> heads_mmHg) const;

  /// One period of the periodic state. Throws InputError for a model that knows means alone.
  [[nodiscard]] rom::PumpPeriod period(double frequency_Hz, double drive, double head_mmHg) const;

  /// The scene that the model was made from (TOML), at an operating point. Throws InputError where the file
  /// does not tell it.
  [[nodiscard]] std::string scene_text(double frequency_Hz, double drive, double head_mmHg) const;

private:
  [[nodiscard]] const std::string& told_scene() const; ///< TOML; empty: not told
  [[nodiscard]] std::string no_period() const;         ///< why; empty: there is one

  LevelSource source_;
  std::unique_ptr<Level> level_;
};

} // namespace undula::apps
