// A small model file that answers quickly, for tests of the command line.
#pragma once

#include <filesystem>

#include "rom/fixed_domain/model.hpp"
#include "tests/unit/rom/synthetic_operators.hpp"

namespace undula::apps {

inline rom::Model small_model() {
  rom::Model model;
  model.operators = rom::synthetic_operators({4, 2, 2}, 0.1);
  model.steps_per_period = 48;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  model.error_safety = 2;
  model.error_floor_l_per_min = 0.01;
  model.provenance["scene"] = "synthetic";
  return model;
}

inline std::filesystem::path write_small_model(const std::filesystem::path& folder) {
  const auto file = folder / "small.h5";
  rom::save_model(small_model(), file.string());
  return file;
}

} // namespace undula::apps
