#include "apps/input/tiers.hpp"

#include <algorithm>
#include <filesystem>

#include "fom/output/root_rank.hpp"
#include "fom/scene/scene_checks.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/sampling/trainable_scene.hpp"

namespace undula::apps {

std::string tier_name(const LevelSource& source) {
  return source.emulator ? "emulator"
         : source.moving ? "reduced model, moving domain"
         : source.model  ? "reduced model"
                         : "scene " + source.scene.name;
}

TierSources read_tiers(const LevelSource& first, const std::vector<std::string>& then,
                       const std::vector<std::string>& overrides, const std::string& campaign) {
  TierSources tiers{{first}, campaign};
  const auto& at = first.scene.operating_point;
  const bool by_voltage = at.drive == Drive::voltage;
  for (const std::string& file : then) {
    tiers.sources.push_back(read_level_source(
        file, is_scene(file) ? overrides : std::vector<std::string>{}, at.frequency,
        by_voltage ? std::nullopt : std::optional(units::length_to_mm(at.stroke * at.stroke_scale)),
        by_voltage ? std::optional(at.voltage) : std::nullopt));
  }
  for (const LevelSource& source : tiers.sources) {
    if (source.scene.operating_point.drive != at.drive) {
      throw InputError("levels of one curve have one drive", source.file + " is driven otherwise",
                       "models and scenes with the same operating_point.drive", "--then");
    }
  }
  const auto is_scene_source = [](const LevelSource& source) { return !source.is_model(); };
  const auto scenes = std::ranges::count_if(tiers.sources, is_scene_source);
  if (!campaign.empty() && scenes != 1) {
    throw InputError("a campaign records the runs of one scene",
                     std::to_string(scenes) + " scenes beside --campaign " + campaign, "--then SCENE.toml",
                     "--campaign");
  }
  for (const LevelSource& source : tiers.sources) {
    if (!campaign.empty() && is_scene_source(source)) {
      training::require_trainable(source.scene);
      check_training(source.scene, source.scene.file.string());
    }
  }
  return tiers;
}

void prepare_tiers(const TierSources& sources, double tolerance_l_per_min, MPI_Comm comm, PhaseTimer& timer,
                   Tiers& tiers) {
  std::vector<Tier> list;
  for (const LevelSource& source : sources.sources) {
    const bool recorded = !source.is_model() && !sources.campaign.empty();
    if (!recorded) {
      list.push_back({tier_name(source), source.scene,
                      [&source, comm, &timer] { return prepare(source, comm, timer); }});
      continue;
    }
    // One rank makes the folder; the others find it.
    CampaignStore* store = nullptr;
    const auto open = [&] {
      store = &tiers.stores.emplace_back(CampaignStore::of_scene(sources.campaign, source.scene));
    };
    on_root(comm, open);
    if (store == nullptr) {
      open();
    }
    list.push_back({tier_name(source), source.scene, [&source, store, comm] {
                      return std::make_unique<training::RecordedLevel>(source.scene, *store, comm);
                    }});
  }
  tiers.level = std::make_unique<HybridLevel>(std::move(list), tolerance_l_per_min);
}

} // namespace undula::apps
