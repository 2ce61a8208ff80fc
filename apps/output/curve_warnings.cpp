#include "apps/output/curve_warnings.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <string>
#include <vector>

#include "apps/output/text_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {

std::string film_remark(double unresolved_percent, double least_elements) {
  return "the narrowest film has fewer than four elements in " + decimals(unresolved_percent, 0) +
         " % of the period, " + decimals(least_elements, 2) +
         " at its thinnest"
         ": it is not resolved, and the flow is not converged before model.coupling = \"mapped\" agrees";
}

void warn_of_curve(const Level& level, const Scene& scene, std::span<const CurvePoint> points) {
  std::vector<double> heads;
  for (const CurvePoint& point : points) {
    heads.push_back(point.head_mmHg);
  }
  for (const std::string& remark : level.remarks(scene, heads)) {
    spdlog::warn("{}: {}", level.name(), remark);
  }
  for (const CurvePoint& point : points) {
    if (point.periodic) {
      continue;
    }
    const std::string mean = std::isfinite(point.standard_error_l_per_min)
                                 ? "; mean of the last " + std::to_string(point.averaged_periods) +
                                       " periods, standard error " +
                                       decimals(point.standard_error_l_per_min, 3) + " l/min"
                                 : "";
    spdlog::warn("{}: no periodic state at {} mmHg: {}{}", level.name(), plain_number(point.head_mmHg),
                 point.reason, mean);
  }
  for (const CurvePoint& point : points) {
    if (point.film_unresolved_percent > 0) {
      spdlog::warn("{}: at {} mmHg {}", level.name(), plain_number(point.head_mmHg),
                   film_remark(point.film_unresolved_percent, point.film_elements_min));
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
