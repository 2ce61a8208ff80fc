#include "apps/input/reduced_model.hpp"

#include <spdlog/spdlog.h>

namespace undula::apps {

rom::Model read_model(const std::string& file) {
  rom::Model model = rom::load_model(file);
  if (!model.sealed) {
    spdlog::warn(
        "{} carries no seal: a number that changed in it since it was trained would not be noticed "
        "(docs/data.md tells how to seal it)",
        file);
  }
  return model;
}

} // namespace undula::apps
