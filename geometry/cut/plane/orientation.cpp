#include "geometry/cut/plane/orientation.hpp"

#include "geometry/cut/exact/hyperplane_table.hpp"

namespace undula::geometry {

int exact_orientation(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  if (const int sign = orientation(a, b, c).sign(); sign != 0) return sign;
  const auto p = exact_point<2>(a), q = exact_point<2>(b), r = exact_point<2>(c);
  return static_cast<int>(CGAL::sign((p[0] - r[0]) * (q[1] - r[1]) - (p[1] - r[1]) * (q[0] - r[0])));
}

} // namespace undula::geometry
