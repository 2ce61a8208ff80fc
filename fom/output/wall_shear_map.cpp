#include "fom/output/wall_shear_map.hpp"

#include <algorithm>
#include <string>

#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {

void WallShearMap::add(int step, std::span<const double> shear) {
  const int place = (step - 1) % steps_per_period_;
  if (place == 0) {
    sum_.assign(shear.size(), 0.0);
    greatest_.assign(shear.size(), 0.0);
    seen_ = 0;
  }
  if (place != seen_ || sum_.size() != shear.size()) return;
  ++seen_;
  for (std::size_t i = 0; i < shear.size(); ++i) {
    sum_[i] += shear[i];
    greatest_[i] = std::max(greatest_[i], shear[i]);
  }
  if (seen_ < steps_per_period_) return;
  period_ = step / steps_per_period_;
  mean_ = sum_;
  for (double& value : mean_) value /= steps_per_period_;
  maximum_ = greatest_;
}

void write_wall_shear(const WallShearMap& map, std::span<const std::array<Point<2>, 2>> walls,
                      const std::filesystem::path& file) {
  std::string text = "period,r_mm,z_mm,length_mm,mean_dyn_per_cm2,max_dyn_per_cm2\n";
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Point<2> middle = 0.5 * (walls[i][0] + walls[i][1]);
    text += std::to_string(map.period()) + "," + exact_number(units::length_to_mm(middle[0])) + "," +
            exact_number(units::length_to_mm(middle[1])) + "," +
            exact_number(units::length_to_mm((walls[i][1] - walls[i][0]).norm())) + "," +
            exact_number(map.mean()[i]) + "," + exact_number(map.maximum()[i]) + "\n";
  }
  replace_text_file(file, text);
}

} // namespace undula::fom
