// What the explorer knows: one model, and measured curves to show beside it. Answers are texts in JSON.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/level_source.hpp"
#include "apps/input/measured_curve.hpp"

namespace undula::apps {

class ExploredModel {
public:
  /// Reads a reduced model or an emulator, and measured curves. Throws InputError for other files.
  ExploredModel(const std::string& file, const std::vector<std::string>& data);

  /// The model's kind, the ranges of frequency, drive and head, and the measured samples.
  [[nodiscard]] std::string description() const;

  /// What `undula hq FILE --json` prints, with the remarks that it logs. `heads` as for --head. Throws
  /// InputError for what is no point of the model's box, and for more than `most_heads` heads. May be called
  /// from several threads.
  [[nodiscard]] std::string curve(double frequency_Hz, double drive, const std::string& heads) const;

  static constexpr std::size_t most_heads = 200;

private:
  [[nodiscard]] rom::TrainingBox box() const;
  [[nodiscard]] bool by_voltage() const { return source_.emulator && source_.emulator->driven_by_voltage; }
  [[nodiscard]] Scene scene_of(double frequency_Hz, double drive) const;

  LevelSource source_;
  std::unique_ptr<Level> level_;
  std::vector<std::string> data_files_;
  std::vector<MeasuredCurve> measured_;
};

} // namespace undula::apps
