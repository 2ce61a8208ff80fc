// Ranges of keys on the command line of studies.
#pragma once

#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "training/study/study_plan.hpp"

namespace undula::apps {

/// "hose.bore_mm=24:40" or "hose.bore_mm=24:40:5". Throws InputError for anything else.
StudyRange parse_study_range(const std::string& text);

/// `overrides`, and the keys of a plan at their values, as `--set` takes them.
std::vector<std::string> overrides_of(std::vector<std::string> overrides,
                                      const std::vector<std::string>& keys,
                                      const std::vector<double>& values);

} // namespace undula::apps
