#include "fom/scene/body_size.hpp"

#include <cmath>

#include "fom/scene/shape_outline.hpp"

namespace undula::fom {

BodySize::BodySize(const ProblemStatement& problem, const std::string& body)
    : largest_(problem.bodies.at(body).size),
      growth_(problem.domain.growth),
      keys_{"body." + body + ".size_mm"} {
  for (const auto& [name, box] : problem.refinements) {
    if (box.body != body) continue;
    boxes_.push_back({point_of(box.box[0]), point_of(box.box[1]), box.size});
    keys_.push_back("refine." + name + ".size_mm");
  }
}

SizeOfSource BodySize::at(const Point<2>& x) const {
  SizeOfSource smallest = {largest_, 0};
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (const double size = size_about(boxes_[i], growth_, x); size < smallest.size)
      smallest = {size, static_cast<int>(i) + 1};
  return smallest;
}

std::vector<Point<2>> BodySize::divided(const BodyStatement& body,
                                        const std::vector<Point<2>>& corners) const {
  if (boxes_.empty() || body.shape.radius == 0) return corners;
  const Point<2> centre = point_of(body.shape.centre);
  std::vector<Point<2>> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point<2>&a = corners[i], &b = corners[(i + 1) % corners.size()];
    const Point<2> from = a - centre, to = b - centre;
    const double radius = from.norm(), whole = std::atan2(from[0] * to[1] - from[1] * to[0], from.dot(to));
    points.push_back(a);
    if (a[0] == 0 && b[0] == 0) continue; // the axis below a ball
    // Steps along the arc by the size there, scaled to end at b.
    std::vector<double> steps;
    double angle = 0;
    while (angle < std::abs(whole)) {
      const double turned = std::copysign(angle, whole);
      const Point<2> x = centre + Point<2>(std::cos(turned) * from[0] - std::sin(turned) * from[1],
                                           std::sin(turned) * from[0] + std::cos(turned) * from[1]);
      steps.push_back(angle);
      angle += (*this)(x) / radius;
    }
    for (std::size_t k = 1; k < steps.size(); ++k) {
      const double turned = whole * steps[k] / angle;
      points.push_back(centre + Point<2>(std::cos(turned) * from[0] - std::sin(turned) * from[1],
                                         std::sin(turned) * from[0] + std::cos(turned) * from[1]));
    }
  }
  return points;
}

} // namespace undula::fom
