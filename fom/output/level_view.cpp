#include "fom/output/level_view.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "rom/base/error.hpp"

namespace undula::fom {

const NodalField& field_named(const std::vector<NodalField>& fields, const std::string& name) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const NodalField& field) { return field.name == name; });
  if (found != fields.end()) return *found;
  std::string allowed;
  for (const NodalField& field : fields) allowed += (allowed.empty() ? "" : ", ") + field.name;
  throw InputError("there is no such field", name, allowed, "the fields of a level");
}

std::vector<std::array<int, 2>> boundary_edges(const FieldMesh<2>& mesh) {
  std::map<std::array<int, 2>, int> triangles_at;
  for (const auto& cell : mesh.cells)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = cell[i], b = cell[(i + 1) % 3];
      ++triangles_at[{std::min(a, b), std::max(a, b)}];
    }
  std::vector<std::array<int, 2>> edges;
  for (const auto& [edge, triangles] : triangles_at)
    if (triangles == 1) edges.push_back(edge);
  return edges;
}

} // namespace undula::fom
