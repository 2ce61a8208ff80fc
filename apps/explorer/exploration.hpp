// What the explorer knows: models, the first one asked and the others beside it, and measured curves. Answers
// are texts in JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/explorer/explored_model.hpp"
#include "apps/input/measured_curve.hpp"

namespace undula::apps {

class Exploration {
public:
  /// Reads models and measured curves. Throws InputError for other files and for none.
  Exploration(const std::vector<std::string>& models, const std::vector<std::string>& data);

  /// `models`, `measured`, `most_heads`.
  [[nodiscard]] std::string description() const;

  /// What `undula hq FILE --json` prints, with the remarks that it logs. `heads` as for --head. With a
  /// tolerance (l/min) every head is answered by the first of the models, from `model` on, that is driven
  /// alike and knows its error to be within it, as `undula hq FILE --tolerance T --then OTHER`. Throws
  /// InputError for what is no point of the model's box, and for more than `most_heads` heads. This and what
  /// follows may be called from several threads.
  [[nodiscard]] std::string curve(std::size_t model, double frequency_Hz, double drive,
                                  const std::string& heads, const std::optional<double>& tolerance) const;

  /// One period: rom::PumpPeriod by name, membrane_mm as a list of radii.
  [[nodiscard]] std::string period(std::size_t model, double frequency_Hz, double drive,
                                   double head_mmHg) const;

  /// ExploredModel::scene_text.
  [[nodiscard]] std::string scene(std::size_t model, double frequency_Hz, double drive,
                                  double head_mmHg) const;

  static constexpr std::size_t most_heads = 200;

private:
  [[nodiscard]] const ExploredModel& at(std::size_t model) const;
  [[nodiscard]] std::unique_ptr<Level> tiers_from(std::size_t model, double frequency_Hz, double drive,
                                                  double tolerance) const;

  std::vector<ExploredModel> models_;
  std::vector<std::string> data_files_;
  std::vector<MeasuredCurve> measured_;
};

} // namespace undula::apps
