// What a study prints, writes and draws.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "training/study/sensitivity.hpp"
#include "training/study/study_store.hpp"

namespace undula::apps {

struct StudyReport {
  struct Analysis {
    std::string quantity;
    Sensitivities of_keys;
  };
  std::string scene, folder;
  StudyPlan plan;
  std::vector<StudyRange> ranges; ///< of the keys of the plan
  std::vector<StudyRecord> runs;  ///< in the order of the plan
  std::vector<Analysis> analyses; ///< of every quantity that a run has
};

/// Fills `analyses` from the runs that have the quantity.
void analyse(StudyReport& report);

/// "rollers.occlusion = 0.9, hose.bore_mm = 32"
std::string values_text(const std::vector<std::string>& keys, const std::vector<double>& values);

/// `asked`, or the first quantity where nothing is asked for. Throws InputError for a quantity that no run
/// has, NumericsError where no run has any.
std::string chosen_quantity(const StudyReport& report, const std::string& asked);

/// Runs (the first of many) with a few quantities, what failed, and the sensitivities of one quantity.
std::string study_text(const StudyReport& report, const std::string& quantity);

/// Everything.
std::string study_json(const StudyReport& report);

/// One row per run: values, quantities, state, reason, seconds; quantities that a run lacks are empty.
void write_study_table(const StudyReport& report, const std::filesystem::path& file);

/// runs.png: the quantity over every key, with the polynomial's main effects; sensitivities.png: its indices.
/// Into `folder`; a warning where gnuplot is missing.
void plot_study(const StudyReport& report, const std::string& quantity, const std::filesystem::path& folder);

} // namespace undula::apps
