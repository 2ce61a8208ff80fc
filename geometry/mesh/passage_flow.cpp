#include "geometry/mesh/passage_flow.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numbers>
#include <span>

#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

constexpr int level_bands = 24;

Point<2> centroid(const SimplexMesh<2>& mesh, int cell) {
  Point<2> sum = Point<2>::Zero();
  for (const int point : mesh.cells[cell]) sum += mesh.points[point];
  return sum / 3;
}

[[noreturn]] void no_passage(const std::string& opening, const char* seen) {
  throw InputError("no passage leads from the " + opening + " to the gaps", seen,
                   "a channel of fluid between them", "the pump's profile");
}

/// Area of the level sets of a potential, mean over equal bands of its values from 0 to 1 (coarea formula).
double narrowest_level_set(std::span<const std::array<double, 3>> values,
                           std::span<const double> gradient_volume) {
  std::vector<double> area(level_bands, 0.0);
  for (std::size_t c = 0; c < values.size(); ++c) {
    const auto [low, high] = std::minmax_element(values[c].begin(), values[c].end());
    const double extent = *high - *low;
    for (int band = 0; band < level_bands && extent > 0; ++band) {
      const double from = std::max(*low, static_cast<double>(band) / level_bands);
      const double to = std::min(*high, static_cast<double>(band + 1) / level_bands);
      if (to > from) area[band] += level_bands * gradient_volume[c] * (to - from) / extent;
    }
  }
  return *std::min_element(area.begin(), area.end());
}

} // namespace

PassageFlow passage_flow(const SimplexMesh<2>& mesh, const std::string& opening,
                         const std::function<bool(const Point<2>&)>& inside,
                         const std::function<bool(const Point<2>&)>& open,
                         const std::function<double(const Point<2>&)>& friction) {
  // 1. The cells of the passage, and its two ends.
  std::vector<char> in_passage(mesh.cells.size()), is_open(mesh.cells.size());
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    const Point<2> x = centroid(mesh, cell);
    in_passage[cell] = inside(x);
    is_open[cell] = in_passage[cell] || open(x);
  }
  enum class Place : char { outside, within, opening_end, gap_end };
  std::vector<Place> place(mesh.points.size(), Place::outside);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    if (in_passage[cell])
      for (const int point : mesh.cells[cell]) place[point] = Place::within;
  bool has_opening = false, has_gap_end = false;
  for (const auto& facet : build_facet_table(mesh).facets) {
    const auto [a, b] = facet.cells;
    if (b < 0) {
      if (facet.boundary_tag < 0 || mesh.boundary_names[facet.boundary_tag] != opening || !in_passage[a])
        continue;
      for (const int point : facet.points) place[point] = Place::opening_end;
      has_opening = true;
    } else if (in_passage[a] != in_passage[b] && is_open[a] && is_open[b]) {
      for (const int point : facet.points) place[point] = Place::gap_end;
      has_gap_end = true;
    }
  }
  if (!has_opening) no_passage(opening, "no boundary of this name at it");
  if (!has_gap_end) no_passage(opening, "no end of it in the gaps");

  // 2. The potential: 0 at the opening, 1 at the gaps.
  std::vector<int> row(mesh.points.size(), -1);
  int rows = 0;
  for (std::size_t point = 0; point < place.size(); ++point)
    if (place[point] == Place::within) row[point] = rows++;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(rows), potential = Eigen::VectorXd::Zero(place.size());
  for (std::size_t point = 0; point < place.size(); ++point)
    if (place[point] == Place::gap_end) potential[point] = 1;
  const auto volume = [&](int cell) {
    return 2 * std::numbers::pi * centroid(mesh, cell)[0] * cell_measure(mesh, cell);
  };
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    if (!in_passage[cell]) continue;
    const auto gradients = barycentric_gradients(mesh, cell);
    const auto& points = mesh.cells[cell];
    for (int i = 0; i < 3; ++i) {
      if (row[points[i]] < 0) continue;
      for (int j = 0; j < 3; ++j) {
        const double entry = volume(cell) * gradients.col(i).dot(gradients.col(j));
        if (row[points[j]] >= 0)
          entries.emplace_back(row[points[i]], row[points[j]], entry);
        else
          load[row[points[i]]] -= entry * potential[points[j]];
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) no_passage(opening, "a part of it that no wall or opening bounds");
  const Eigen::VectorXd inner = solver.solve(load);
  for (std::size_t point = 0; point < place.size(); ++point)
    if (row[point] >= 0) potential[point] = inner[row[point]];

  // 3. Flow = Dirichlet energy at a potential difference of one.
  double flow = 0, dissipation = 0;
  std::vector<std::array<double, 3>> values;
  std::vector<double> gradient_volume;
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    if (!in_passage[cell]) continue;
    const auto& points = mesh.cells[cell];
    values.push_back({potential[points[0]], potential[points[1]], potential[points[2]]});
    const Point<2> velocity = barycentric_gradients(mesh, cell) *
                              Eigen::Vector3d(values.back()[0], values.back()[1], values.back()[2]);
    flow += volume(cell) * velocity.squaredNorm();
    dissipation += volume(cell) * velocity.squaredNorm() * friction(centroid(mesh, cell));
    gradient_volume.push_back(volume(cell) * velocity.norm());
  }
  // Rounding alone leaves about the square of its own size.
  constexpr double rounding = 1e-20;
  if (!(flow > rounding * matrix.diagonal().sum())) no_passage(opening, "no way through");
  return {1 / flow, dissipation / (flow * flow), narrowest_level_set(values, gradient_volume)};
}

} // namespace undula::geometry
