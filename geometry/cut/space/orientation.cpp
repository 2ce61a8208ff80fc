#include "geometry/cut/space/orientation.hpp"

#include "geometry/cut/exact/hyperplane_table.hpp"

namespace undula::geometry {

int exact_orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) {
  if (const int sign = orientation(a, b, c, d).sign(); sign != 0) return sign;
  const auto o = exact_point<3>(a);
  std::array<ExactPoint<3>, 3> edges{exact_point<3>(b), exact_point<3>(c), exact_point<3>(d)};
  for (auto& edge : edges)
    for (int i = 0; i < 3; ++i) edge[i] -= o[i];
  const auto& [p, q, r] = edges;
  return static_cast<int>(CGAL::sign(p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                                     p[2] * (q[0] * r[1] - q[1] * r[0])));
}

} // namespace undula::geometry
