#include "apps/input/reduced_model.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"

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

void require_flows(std::span<const rom::HqPoint> points) {
  for (const rom::HqPoint& point : points) {
    if (!std::isfinite(point.flow_l_per_min)) {
      throw NumericsError("the reduced model has no answer", "head " + shortest(point.head_mmHg) + " mmHg",
                          "frequencies, strokes and heads in the box that the model was trained in");
    }
  }
}

} // namespace undula::apps
