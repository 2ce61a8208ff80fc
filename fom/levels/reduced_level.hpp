// A reduced model behind the door.
#pragma once

#include "fom/levels/level.hpp"
#include "rom/curve/hq_curve.hpp"

namespace undula::fom {

class ReducedLevel final : public Level {
public:
  explicit ReducedLevel(rom::Model model) : model_(std::move(model)) {}

  std::string name() const override { return "reduced model"; }
  int unknowns() const override;

  /// Periodic states found directly (rom::hq_curve), with the error that the model expects of itself.
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;

  /// Parameters outside the training box.
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;

  const rom::Model& model() const { return model_; }

private:
  rom::Model model_;
};

/// What a reduced model says of the scene it stands for: operating point and training box alone. The head is
/// the middle of the box.
Scene scene_of_model(const rom::Model& model, const std::string& name, double frequency_Hz, double stroke_mm);

} // namespace undula::fom
