// The levels of `hq --tolerance`: the file asked, and those that stand behind it.
#pragma once

#include <deque>

#include "apps/input/level_source.hpp"
#include "fom/levels/hybrid_level.hpp"
#include "training/campaign/recorded_level.hpp"

namespace undula::apps {

/// What a source is called as a tier.
std::string tier_name(const LevelSource& source);

/// What `--then` states, read and checked before anything runs.
struct TierSources {
  std::vector<LevelSource> sources; ///< cheapest first, the file asked among them
  std::string campaign;             ///< folder of the runs of a scene; empty: not recorded
};

/// `first` and then every file of `then`, at its frequency and drive; scenes among them with `overrides`.
/// Throws InputError for a `campaign` without a scene or with several, a scene that no campaign can run, and
/// levels that are driven otherwise.
TierSources read_tiers(const LevelSource& first, const std::vector<std::string>& then,
                       const std::vector<std::string>& overrides, const std::string& campaign);

/// Levels behind one door, with the folder that their runs go to. Not copied: the level holds on to it.
struct Tiers {
  std::deque<CampaignStore> stores;
  std::unique_ptr<HybridLevel> level;
};

/// Collective over `comm`.
void prepare_tiers(const TierSources& sources, double tolerance_l_per_min, MPI_Comm comm, PhaseTimer& timer,
                   Tiers& tiers);

} // namespace undula::apps
