#include "geometry/cut/dof_matching.hpp"

#include <algorithm>
#include <string>

#include "geometry/cut/part_lookup.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

constexpr double least_overlap = 1e-9; // of the smaller part; less is rounding of the parts' corners

// Measure of the quadrature points of `part` that lie in the part `other` of the other cut.
template <int dim>
double sampled_overlap(const CutMesh<dim>& cut, int part, const CutMesh<dim>& other_cut, int other) {
  const auto& record = cut.parts[part];
  double sum = 0;
  for (int q = record.quadrature_begin; q < record.quadrature_end; ++q)
    if (part_contains(other_cut, other, cut.volume_quadrature.points[q]))
      sum += cut.volume_quadrature.weights[q];
  return sum;
}

template <int dim>
double overlap(const CutMesh<dim>& before, int part_before, const CutMesh<dim>& now, int part_now) {
  const auto& a = before.parts[part_before];
  const auto& b = now.parts[part_now];
  if (!a.cut || !b.cut) return std::min(a.measure, b.measure); // one is the whole cell
  const double sum = std::max(sampled_overlap(before, part_before, now, part_now),
                              sampled_overlap(now, part_now, before, part_before));
  return sum > least_overlap * std::min(a.measure, b.measure) ? sum : 0;
}

// [point], [point + 1): range of the unknowns of a background point.
std::vector<int> unknowns_of_points(const std::vector<int>& dof_point, std::size_t points) {
  std::vector<int> first(points + 1, 0);
  for (const int point : dof_point) ++first[point + 1];
  for (std::size_t p = 0; p < points; ++p) first[p + 1] += first[p];
  return first;
}

// The overlaps of the unknowns at one point, rows now, columns before.
struct Overlaps {
  const double* values;
  int rows, columns;
  double operator()(int row, int column) const { return values[row * columns + column]; }
  int row_degree(int row) const {
    int degree = 0;
    for (int c = 0; c < columns; ++c) degree += (*this)(row, c) > 0;
    return degree;
  }
  int column_degree(int column) const {
    int degree = 0;
    for (int r = 0; r < rows; ++r) degree += (*this)(r, column) > 0;
    return degree;
  }
  int largest_in_row(int row) const {
    int best = 0;
    for (int c = 1; c < columns; ++c)
      if ((*this)(row, c) > (*this)(row, best)) best = c;
    return best;
  }
  int largest_in_column(int column) const {
    int best = 0;
    for (int r = 1; r < rows; ++r)
      if ((*this)(r, column) > (*this)(best, column)) best = r;
    return best;
  }
};

// Column matched to each row, -1 if none.
std::vector<int> match_at_point(const Overlaps& overlaps) {
  std::vector<int> match(overlaps.rows, -1);
  // Chains: an overlap between an unknown now that has several and an unknown before that has several spoils
  // all that hang together with it.
  std::vector<char> bad_row(overlaps.rows, 0), bad_column(overlaps.columns, 0);
  for (int r = 0; r < overlaps.rows; ++r)
    for (int c = 0; c < overlaps.columns; ++c)
      if (overlaps(r, c) > 0 && overlaps.row_degree(r) > 1 && overlaps.column_degree(c) > 1)
        bad_row[r] = bad_column[c] = 1;
  for (bool changed = true; changed;) {
    changed = false;
    for (int r = 0; r < overlaps.rows; ++r)
      for (int c = 0; c < overlaps.columns; ++c)
        if (overlaps(r, c) > 0 && bad_row[r] != bad_column[c]) bad_row[r] = bad_column[c] = changed = true;
  }
  for (int r = 0; r < overlaps.rows; ++r) {
    if (bad_row[r] || overlaps.row_degree(r) == 0) continue;
    const int column = overlaps.largest_in_row(r);
    if (overlaps.largest_in_column(column) == r) match[r] = column;
  }
  return match;
}

} // namespace

template <int dim>
std::vector<int> match_dofs(const CutMesh<dim>& before, const DofSets<dim>& dofs_before,
                            const CutMesh<dim>& now, const DofSets<dim>& dofs_now) {
  const std::size_t points = now.mesh.points.size();
  if (before.mesh.points.size() != points || before.mesh.cells != now.mesh.cells)
    throw InputError(
        "unknowns are matched between cuts of different background meshes",
        std::to_string(before.mesh.cells.size()) + " and " + std::to_string(now.mesh.cells.size()) + " cells",
        "two cuts of the same mesh", "match_dofs");
  const auto first_before = unknowns_of_points(dofs_before.dof_point, points);
  const auto first_now = unknowns_of_points(dofs_now.dof_point, points);

  // One dense block of overlaps per point.
  std::vector<std::size_t> block(points + 1, 0);
  for (std::size_t p = 0; p < points; ++p)
    block[p + 1] = block[p] + static_cast<std::size_t>(first_now[p + 1] - first_now[p]) *
                                  (first_before[p + 1] - first_before[p]);
  std::vector<double> overlaps(block.back(), 0.0);
  for (int cell = 0; cell < static_cast<int>(now.mesh.cells.size()); ++cell)
    for (int b = now.cell_parts[cell]; b < now.cell_parts[cell + 1]; ++b)
      for (int a = before.cell_parts[cell]; a < before.cell_parts[cell + 1]; ++a) {
        const double shared = overlap(before, a, now, b);
        for (int i = 0; i <= dim; ++i) {
          const int point = now.mesh.cells[cell][i];
          const int row = dofs_now.part_dofs[b][i] - first_now[point];
          const int column = dofs_before.part_dofs[a][i] - first_before[point];
          const int columns = first_before[point + 1] - first_before[point];
          overlaps[block[point] + static_cast<std::size_t>(row) * columns + column] += shared;
        }
      }

  std::vector<int> matched(dofs_now.dof_point.size(), -1);
  for (std::size_t p = 0; p < points; ++p) {
    const int rows = first_now[p + 1] - first_now[p];
    const int columns = first_before[p + 1] - first_before[p];
    if (rows == 0 || columns == 0) continue;
    if (rows == 1 && columns == 1) {
      if (overlaps[block[p]] > 0) matched[first_now[p]] = first_before[p];
      continue;
    }
    const auto match = match_at_point({overlaps.data() + block[p], rows, columns});
    for (int r = 0; r < rows; ++r)
      if (match[r] >= 0) matched[first_now[p] + r] = first_before[p] + match[r];
  }
  return matched;
}

template std::vector<int> match_dofs<2>(const CutMesh<2>&, const DofSets<2>&, const CutMesh<2>&,
                                        const DofSets<2>&);
template std::vector<int> match_dofs<3>(const CutMesh<3>&, const DofSets<3>&, const CutMesh<3>&,
                                        const DofSets<3>&);

} // namespace undula::geometry
