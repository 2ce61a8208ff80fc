#include "apps/output/curve_warnings.hpp"

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {

void warn_of_curve(const Level& level, const Scene& scene, std::span<const CurvePoint> points) {
  std::vector<double> heads;
  for (const CurvePoint& point : points) {
    heads.push_back(point.head_mmHg);
  }
  for (const std::string& remark : level.remarks(scene, heads)) {
    spdlog::warn("{}: {}", level.name(), remark);
  }
  for (const CurvePoint& point : points) {
    if (!point.periodic) {
      spdlog::warn("{}: no periodic state at {} mmHg: {}", level.name(), plain_number(point.head_mmHg),
                   point.reason);
    }
  }
  for (const CurvePoint& point : points) {
    if (point.clearance_min_mm < 0) {
      spdlog::warn(
          "{}: at {} mmHg the membrane passes through a wall by {} mm: the flow is not that of a pump",
          level.name(), plain_number(point.head_mmHg), decimals(-point.clearance_min_mm, 3));
    }
  }
}

} // namespace undula::apps
