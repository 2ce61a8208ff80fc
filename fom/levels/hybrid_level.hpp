// Several levels behind one door: every head is answered by the first whose error is small enough.
#pragma once

#include "fom/levels/level.hpp"

namespace undula::fom {

/// One level of several, cheapest first.
struct Tier {
  std::string name;
  Scene scene;                                     ///< what it is asked with, but for the operating point
  std::function<std::unique_ptr<Level>()> prepare; ///< called when it is first needed. Collective
};

class HybridLevel final : public Level {
public:
  /// `tolerance`: l/min. At least one tier.
  HybridLevel(std::vector<Tier> tiers, double tolerance_l_per_min);

  std::string name() const override { return "hybrid"; }
  /// Of the first tier.
  int unknowns() const override;

  /// Every head by the first tier that knows its error to be within the tolerance: the error that it states,
  /// else the standard error of its mean flow, 0 where that repeats. Where none does, by the one with the
  /// least error. CurvePoint::tier and CurvePoint::why tell which.
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;

  /// Those of the tiers that have answered.
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;

private:
  Level& level(std::size_t tier);

  std::vector<Tier> tiers_;
  std::vector<std::unique_ptr<Level>> levels_; ///< by tier; null: not needed yet
  double tolerance_;
};

} // namespace undula::fom
