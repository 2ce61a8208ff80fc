// Draws a cut as SVG: the picture of docs/architecture.md. Needs geometry/ only.
//   example_draw_cut > docs/pictures/cut_cell.svg
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>

#include "geometry/cut/cut.hpp"
#include "geometry/mesh/polygons.hpp"

namespace {

using namespace undula::geometry;
using Triangle = std::array<Point<2>, 3>;

constexpr int columns = 6, rows = 4;
const double row_height = std::sqrt(3.0) / 2;

/// Rows of equilateral triangles with sides of 1, in a frame without names.
SimplexMesh<2> background() {
  SimplexMesh<2> mesh;
  const auto at = [](int row, int column) { return row * (columns + 1) + column; };
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      mesh.points.emplace_back(column + 0.5 * (row % 2), row * row_height);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int a = at(row, column), b = at(row, column + 1), c = at(row + 1, column),
                d = at(row + 1, column + 1);
      if (row % 2 == 0) {
        mesh.cells.push_back({a, b, c});
        mesh.cells.push_back({b, d, c});
      } else {
        mesh.cells.push_back({a, b, d});
        mesh.cells.push_back({a, d, c});
      }
    }
  mesh.boundary_names = {"frame"};
  for (const auto& facet : build_facet_table(mesh).facets)
    if (facet.cells[1] < 0) mesh.boundary.push_back({facet.points, 0});
  return mesh;
}

double middle_of_membrane(double x) { return 2.2 + 0.15 * std::sin(1.3 * x); }

/// A membrane, thinner than an element, that ends in the middle and reaches out of the frame.
SimplexMesh<2> membrane() {
  SimplexMesh<2> mesh;
  constexpr int pieces = 16;
  for (int k = 0; k <= pieces; ++k) {
    const double x = 2.75 + 4.25 * k / pieces, y = middle_of_membrane(x);
    mesh.points.emplace_back(x, y - 0.13);
    mesh.points.emplace_back(x, y + 0.13);
  }
  for (int k = 0; k < pieces; ++k) {
    mesh.cells.push_back({2 * k, 2 * k + 2, 2 * k + 3});
    mesh.cells.push_back({2 * k, 2 * k + 3, 2 * k + 1});
  }
  mesh.boundary_names = {"skin"};
  for (const auto& facet : build_facet_table(mesh).facets)
    if (facet.cells[1] < 0) mesh.boundary.push_back({facet.points, 0});
  return mesh;
}

constexpr double scale = 90, margin = 14;
double right(const Point<2>& x) { return margin + scale * x[0]; }
double down(const Point<2>& x) { return margin + scale * (rows * row_height - x[1]); }

void draw(const Triangle& x, const char* fill, const char* line) {
  std::printf("<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" fill=\"%s\" stroke=\"%s\"/>\n", right(x[0]),
              down(x[0]), right(x[1]), down(x[1]), right(x[2]), down(x[2]), fill, line);
}

Triangle corners(const SimplexMesh<2>& mesh, int cell) {
  const auto& v = mesh.cells[static_cast<std::size_t>(cell)];
  return {mesh.points[static_cast<std::size_t>(v[0])], mesh.points[static_cast<std::size_t>(v[1])],
          mesh.points[static_cast<std::size_t>(v[2])]};
}

void draw_cut() {
  // 1. Two meshes that know nothing of each other, and the cut.
  const auto solid = membrane();
  const auto cut = cut_mesh<2>(background(), std::span(&solid, 1), CutOptions{});
  const auto unknowns = build_dof_sets<2>(cut);

  // 2. Where the middle of every part is.
  std::vector<Point<2>> middles;
  for (const auto& part : cut.parts) {
    Point<2> moment = Point<2>::Zero();
    double area = 0;
    const auto add = [&](const Triangle& x) {
      const double share = polygon_area({x[0], x[1], x[2]});
      moment += share * (x[0] + x[1] + x[2]) / 3;
      area += share;
    };
    if (!part.cut) add(corners(cut.mesh, part.cell));
    for (int s = part.simplex_begin; s < part.simplex_end; ++s)
      add(cut.simplices[static_cast<std::size_t>(s)]);
    middles.push_back(moment / area);
  }

  // 3. The fluid: whole elements white, parts of cut ones coloured, those above and below the membrane in
  // two colours where an element has both.
  std::printf(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" stroke-width=\"1\">\n",
      2 * margin + scale * (columns + 0.5), 2 * margin + scale * rows * row_height);
  std::printf("<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n");
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& part = cut.parts[p];
    const auto cell = static_cast<std::size_t>(part.cell);
    const bool alone = cut.cell_parts[cell + 1] - cut.cell_parts[cell] == 1;
    const bool above = middles[p][1] > middle_of_membrane(middles[p][0]);
    const char* fill = alone ? "#deebf7" : above ? "#9ecae1" : "#fdd0a2";
    for (int s = part.simplex_begin; s < part.simplex_end; ++s)
      draw(cut.simplices[static_cast<std::size_t>(s)], fill, fill);
  }
  for (int cell = 0; cell < static_cast<int>(cut.mesh.cells.size()); ++cell)
    draw(corners(cut.mesh, cell), "none", "#969696");

  // 4. The membrane with its own mesh.
  for (int cell = 0; cell < static_cast<int>(solid.cells.size()); ++cell)
    draw(corners(solid, cell), "#bdbdbd", "#636363");

  // 5. The unknowns: a dot for each, a little towards the parts it belongs to.
  std::vector<Point<2>> centre(unknowns.dof_point.size(), Point<2>::Zero());
  std::vector<int> count(unknowns.dof_point.size(), 0);
  for (std::size_t part = 0; part < cut.parts.size(); ++part) {
    for (const int unknown : unknowns.part_dofs[part]) {
      centre[static_cast<std::size_t>(unknown)] += middles[part];
      ++count[static_cast<std::size_t>(unknown)];
    }
  }
  for (std::size_t i = 0; i < unknowns.dof_point.size(); ++i) {
    const auto& point = cut.mesh.points[static_cast<std::size_t>(unknowns.dof_point[i])];
    const auto here = std::count(unknowns.dof_point.begin(), unknowns.dof_point.end(), unknowns.dof_point[i]);
    const Point<2> towards = (centre[i] / count[i] - point).normalized();
    const Point<2> at = here == 1 ? point : Point<2>(point + 0.11 * towards);
    std::printf("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/>\n", right(at), down(at),
                here == 1 ? "#252525" : "#cb181d");
  }
  std::printf("</svg>\n");
}

} // namespace

int main() try {
  draw_cut();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
