#include "fom/levels/hybrid_level.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

/// What a point knows of its own error; infinite: nothing.
double known_error(const CurvePoint& point) {
  if (!std::isfinite(point.flow_l_per_min)) return std::numeric_limits<double>::infinity();
  if (!std::isnan(point.error_l_per_min)) return point.error_l_per_min;
  if (point.periodic) return 0;
  return std::isfinite(point.standard_error_l_per_min) ? point.standard_error_l_per_min
                                                       : std::numeric_limits<double>::infinity();
}

Scene asked(const Tier& tier, const Scene& scene) {
  Scene there = tier.scene;
  // The stroke of a scene that a voltage drives is no drive.
  auto& at = there.operating_point;
  at.frequency = scene.operating_point.frequency;
  if (at.drive == Drive::voltage) {
    at.voltage = scene.operating_point.voltage;
  } else {
    at.stroke = scene.operating_point.stroke * scene.operating_point.stroke_scale;
    at.stroke_scale = 1;
  }
  return there;
}

std::string error_text(const std::string& tier, double error) {
  char text[64];
  std::snprintf(text, sizeof text, ": error %.3f l/min", error);
  return tier + (std::isfinite(error) ? text : ": error not known");
}

} // namespace

HybridLevel::HybridLevel(std::vector<Tier> tiers, double tolerance_l_per_min)
    : tiers_(std::move(tiers)), levels_(tiers_.size()), tolerance_(tolerance_l_per_min) {
  levels_.front() = tiers_.front().prepare();
}

Level& HybridLevel::level(std::size_t tier) {
  if (!levels_[tier]) levels_[tier] = tiers_[tier].prepare();
  return *levels_[tier];
}

int HybridLevel::unknowns() const { return levels_.front()->unknowns(); }

std::vector<CurvePoint> HybridLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                           const std::function<void()>& on_point) {
  std::vector<CurvePoint> best(heads_mmHg.size());
  std::vector<double> errors(heads_mmHg.size(), std::numeric_limits<double>::infinity());
  std::vector<std::string> seen(heads_mmHg.size());
  for (std::size_t tier = 0; tier < tiers_.size(); ++tier) {
    std::vector<std::size_t> open;
    std::vector<double> heads;
    for (std::size_t i = 0; i < heads_mmHg.size(); ++i)
      if (errors[i] > tolerance_) {
        open.push_back(i);
        heads.push_back(heads_mmHg[i]);
      }
    if (open.empty()) break;
    const auto points = level(tier).curve(asked(tiers_[tier], scene), heads);
    for (std::size_t k = 0; k < open.size(); ++k) {
      const std::size_t i = open[k];
      const double error = known_error(points[k]);
      seen[i] += (seen[i].empty() ? "" : "; ") + error_text(tiers_[tier].name, error);
      const bool first_answer =
          std::isfinite(points[k].flow_l_per_min) && !std::isfinite(best[i].flow_l_per_min);
      if (tier > 0 && !(error < errors[i]) && !first_answer) continue;
      best[i] = points[k];
      best[i].tier = tiers_[tier].name;
      errors[i] = error;
      if (error <= tolerance_ && on_point) on_point();
    }
  }
  for (std::size_t i = 0; i < best.size(); ++i) {
    best[i].head_mmHg = heads_mmHg[i];
    best[i].error_l_per_min = errors[i];
    best[i].why =
        seen[i] + (errors[i] <= tolerance_ ? ", within " : ", none within ") + plain_number(tolerance_);
    if (!(errors[i] <= tolerance_) && on_point) on_point();
  }
  return best;
}

std::vector<std::string> HybridLevel::remarks(const Scene& scene, std::span<const double> heads_mmHg) const {
  std::vector<std::string> sentences;
  for (std::size_t tier = 0; tier < tiers_.size(); ++tier)
    if (levels_[tier])
      for (const auto& sentence : levels_[tier]->remarks(asked(tiers_[tier], scene), heads_mmHg))
        sentences.push_back(tiers_[tier].name + ": " + sentence);
  return sentences;
}

} // namespace undula::fom
