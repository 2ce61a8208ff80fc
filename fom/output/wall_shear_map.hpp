// Shear on the walls over a period, place by place.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// Sums up over the steps of a period, and keeps the last whole one.
class WallShearMap {
public:
  explicit WallShearMap(int steps_per_period) : steps_per_period_(steps_per_period) {}

  /// Shear of all walls (dyn/cm^2) after `step`. A period that is not seen from its first step on does not
  /// count.
  void add(int step, std::span<const double> shear);

  int period() const { return period_; } ///< the last whole one, from 1; 0: none yet
  bool has_period() const { return !mean_.empty(); }
  const std::vector<double>& mean() const { return mean_; } ///< dyn/cm^2, of the last whole period
  const std::vector<double>& maximum() const { return maximum_; }

private:
  int steps_per_period_;
  int period_ = 0;
  int seen_ = 0; ///< steps of the present period; 0: it has not begun
  std::vector<double> sum_, greatest_, mean_, maximum_;
};

/// "period,r_mm,z_mm,length_mm,mean_dyn_per_cm2,max_dyn_per_cm2" by wall element, in one step.
void write_wall_shear(const WallShearMap& map, std::span<const std::array<Point<2>, 2>> walls,
                      const std::filesystem::path& file);

} // namespace undula::fom
