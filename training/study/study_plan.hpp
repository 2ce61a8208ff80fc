// Where a study runs a scene: a full or a space-filling plan over keys of it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fom/scene/scene.hpp"
#include "training/training.hpp"

namespace undula::training {

/// A key of a scene and the values it goes through, in its unit.
struct StudyRange {
  std::string key;
  double low = 0, high = 0;
  int count = 0; ///< values of a full plan, both ends among them; 0: none stated
};

struct StudyPlan {
  std::vector<std::string> keys;
  std::vector<std::vector<double>> points; ///< [run][key]
  bool full = false;                       ///< every value of every key with every other
};

/// Most keys of a study: the values are part of the names of its records.
inline constexpr int most_study_keys = 8;

/// Most runs of a study.
inline constexpr int most_study_runs = 10000;

/// A full plan where every range states a count (the last key runs fastest); else the first `points` of a
/// scrambled Halton sequence over the box, of which a larger number keeps the earlier ones. The same on every
/// machine. Throws InputError for no or too many ranges or runs, a key that is unknown to the scene, no
/// number, stated twice or outside of what it accepts, low >= high, counts for some keys and not for others,
/// and whole-number keys whose values are none.
StudyPlan plan_study(const Scene& scene, std::span<const StudyRange> ranges, int points);

} // namespace undula::training
