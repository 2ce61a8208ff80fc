#include <algorithm>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/member_sets.hpp"

namespace undula::geometry {
template <int dim>
DofSets<dim> build_dof_sets(const CutMesh<dim>& cut) {
  const int n_parts = static_cast<int>(cut.parts.size());
  MemberSets sets(static_cast<std::size_t>(n_parts) * (dim + 1));
  const auto corner = [&](int part, int point) {
    const auto& points = cut.mesh.cells[cut.parts[part].cell];
    const auto local = std::find(points.begin(), points.end(), point) - points.begin();
    return part * (dim + 1) + static_cast<int>(local);
  };
  for (const auto& connection : cut.connections)
    for (const int point : cut.facets.facets[connection.facet].points)
      sets.unite(corner(connection.part[0], point), corner(connection.part[1], point));

  // Unknowns of one point are consecutive, points ascending.
  std::vector<std::pair<int, int>> unknowns; // (point, root)
  for (int part = 0; part < n_parts; ++part)
    for (int i = 0; i <= dim; ++i)
      if (const int c = part * (dim + 1) + i; sets.root(c) == c)
        unknowns.emplace_back(cut.mesh.cells[cut.parts[part].cell][i], c);
  std::sort(unknowns.begin(), unknowns.end());

  DofSets<dim> dofs;
  dofs.part_dofs.resize(n_parts);
  std::vector<int> dof_of_root(static_cast<std::size_t>(n_parts) * (dim + 1), -1);
  for (const auto& [point, root] : unknowns) {
    dof_of_root[root] = static_cast<int>(dofs.dof_point.size());
    dofs.dof_point.push_back(point);
  }
  for (int part = 0; part < n_parts; ++part)
    for (int i = 0; i <= dim; ++i) dofs.part_dofs[part][i] = dof_of_root[sets.root(part * (dim + 1) + i)];
  return dofs;
}

template DofSets<2> build_dof_sets<2>(const CutMesh<2>&);
template DofSets<3> build_dof_sets<3>(const CutMesh<3>&);

} // namespace undula::geometry
