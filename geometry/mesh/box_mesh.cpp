#include "geometry/mesh/box_mesh.hpp"

#include <sstream>

#include "rom/base/error.hpp"

namespace undula::geometry {

SimplexMesh<3> box_mesh(const Box<3>& box, const std::array<int, 3>& counts) {
  const Point<3> size = box.high - box.low;
  for (int i = 0; i < 3; ++i)
    if (!(size[i] > 0) || counts[i] < 1) {
      std::ostringstream seen;
      seen << size[i] << " cm in " << counts[i] << " parts along axis " << i;
      throw InputError("a box cannot be meshed", seen.str(), "a positive length and one part or more",
                       "the box");
    }
  SimplexMesh<3> mesh;
  mesh.boundary_names = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};
  const auto at = [&](int i, int axis) { // both ends exactly
    return i == counts[axis] ? box.high[axis] : box.low[axis] + size[axis] * i / counts[axis];
  };
  for (int k = 0; k <= counts[2]; ++k)
    for (int j = 0; j <= counts[1]; ++j)
      for (int i = 0; i <= counts[0]; ++i) mesh.points.emplace_back(at(i, 0), at(j, 1), at(k, 2));
  const std::array<int, 3> stride = {1, counts[0] + 1, (counts[0] + 1) * (counts[1] + 1)};

  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<int, 3> brick;
  for (brick[2] = 0; brick[2] < counts[2]; ++brick[2])
    for (brick[1] = 0; brick[1] < counts[1]; ++brick[1])
      for (brick[0] = 0; brick[0] < counts[0]; ++brick[0]) {
        const int low = brick[0] + stride[1] * brick[1] + stride[2] * brick[2];
        for (int order = 0; order < 6; ++order) {
          const auto& [a, b, c] = orders[order];
          const int p = low + stride[a], q = p + stride[b], high = q + stride[c];
          const bool even = order < 3;
          mesh.cells.push_back({low, even ? p : q, even ? q : p, high});
          // The facets opposite the high and the low corner lie on sides of the brick.
          if (brick[c] == 0) mesh.boundary.push_back({{low, p, q}, 2 * c});
          if (brick[a] == counts[a] - 1) mesh.boundary.push_back({{p, q, high}, 2 * a + 1});
        }
      }
  return mesh;
}

} // namespace undula::geometry
