#include "geometry/mesh/gmsh_import.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "geometry/mesh/gmsh_file.hpp"
#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/plane_overlay.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Exact sign of the signed measure of a cell.
CGAL::Sign orientation(const SimplexMesh<2>& mesh, const std::array<int, 3>& cell) {
  const auto at = [&](int i) { return Kernel::Point_2(mesh.points[cell[i]].x(), mesh.points[cell[i]].y()); };
  return CGAL::orientation(at(0), at(1), at(2));
}

CGAL::Sign orientation(const SimplexMesh<3>& mesh, const std::array<int, 4>& cell) {
  const auto at = [&](int i) {
    const auto& x = mesh.points[cell[i]];
    return Kernel::Point_3(x.x(), x.y(), x.z());
  };
  return CGAL::orientation(at(0), at(1), at(2), at(3));
}

template <std::size_t n>
std::array<int, n> sorted(std::array<int, n> points) {
  std::sort(points.begin(), points.end());
  return points;
}

template <int dim>
class Importer {
public:
  Importer(const std::filesystem::path& file, double cm_per_unit)
      : file_(file), content_(read_gmsh_file(file)) {
    for (auto& [tag, x] : content_.nodes) {
      x *= cm_per_unit;
      if (x.cwiseAbs().maxCoeff() > farthest)
        fail("a node of the mesh is too far away", "node " + std::to_string(tag) + " at " + place(x),
             "coordinates within 1e5 cm", 0);
    }
    // CAD kernels leave rounding in the coordinate that should be zero.
    for (const auto& [tag, x] : content_.nodes)
      flat_tolerance_ =
          std::max(flat_tolerance_, 1e-12 * x.template head<2>().template lpNorm<Eigen::Infinity>());
  }

  ImportedMesh<dim> run() {
    add_cells();
    check_neighbours();
    collect_named_facets();
    add_boundary();
    if constexpr (dim == 2) check_boundary();
    return std::move(imported_);
  }

private:
  using Cell = std::array<int, dim + 1>;
  using FacetPoints = std::array<int, dim>;
  static constexpr double farthest = 1e5; ///< cm

  [[noreturn]] void fail(const std::string& what, const std::string& seen, const std::string& allowed,
                         int line) const {
    throw InputError(what, seen, allowed,
                     line > 0 ? file_.string() + ":" + std::to_string(line) : file_.string());
  }

  /// Index of a node among the points of the mesh; adds it at its first use.
  int point(long node, int line) {
    const auto [entry, added] = point_of_node_.try_emplace(node, static_cast<int>(mesh().points.size()));
    if (added) {
      const auto& x = content_.nodes.at(node);
      if constexpr (dim == 2)
        if (std::abs(x.z()) > flat_tolerance_)
          fail("a node of the mesh lies off the plane", "z = " + std::to_string(x.z()),
               "z = 0 in two dimensions", line);
      mesh().points.push_back(x.template head<dim>());
    }
    return entry->second;
  }

  void add_cells() {
    for (const auto& element : content_.elements)
      if (gmsh_simplex_dimension(element.type) > dim)
        fail("the mesh has a tetrahedron", "a mesh in three dimensions", "triangles", element.line);
    std::set<Cell> known;
    for (const auto& element : content_.elements) {
      if (gmsh_simplex_dimension(element.type) != dim) continue;
      Cell cell;
      for (int i = 0; i <= dim; ++i) cell[i] = point(element.nodes[i], element.line);
      // MSH 2.2 repeats an element for each of its physical groups.
      if (!known.insert(sorted(cell)).second) continue;
      const auto sign = orientation(mesh(), cell);
      if (sign == CGAL::ZERO) fail("a cell is flat", "zero measure", "a positive measure", element.line);
      if (sign == CGAL::NEGATIVE) {
        std::swap(cell[dim - 1], cell[dim]);
        ++imported_.reoriented_cells;
      }
      mesh().cells.push_back(cell);
      lines_.push_back(element.line);
    }
    if (dim == 2 && mesh().cells.size() > most_cells)
      fail("the mesh has too many cells", std::to_string(mesh().cells.size()),
           "at most " + std::to_string(most_cells), 0);
    if (mesh().cells.empty())
      fail("the mesh has no cells", "0 cells", dim == 2 ? "triangles" : "tetrahedra (dim = 3)", 0);
  }

  /// Two cells that share a facet lie on either side of it. As all of them are positively oriented, they then
  /// go through its points in opposite directions.
  void check_neighbours() const {
    struct Side {
      bool even;
      int cell;
    };
    std::map<FacetPoints, Side> first;
    for (int cell = 0; cell < static_cast<int>(mesh().cells.size()); ++cell)
      for_facets(mesh().cells[cell], [&](const FacetPoints& facet, int opposite) {
        const bool even = (inversions(facet) + opposite) % 2 == 0;
        const auto [entry, added] = first.try_emplace(sorted(facet), Side{even, cell});
        if (!added && entry->second.even == even)
          fail("cells of the mesh lie over one another: neighbours on the same side of their common facet",
               "cells in lines " + std::to_string(lines_[entry->second.cell]) + " and " +
                   std::to_string(lines_[cell]) + ", common " + text(facet),
               "cells that share facets and corners alone", lines_[cell]);
      });
  }

  static int inversions(const FacetPoints& facet) {
    int count = 0;
    for (int i = 0; i < dim; ++i)
      for (int j = i + 1; j < dim; ++j) count += facet[i] > facet[j];
    return count;
  }

  /// Neighbours on either side of every facet, and a boundary that does not cross itself: then every point of
  /// the plane is in one cell at most.
  void check_boundary() const {
    PlaneRegion sides;
    double area = 0;
    for (const auto& facet : mesh().boundary)
      sides.push_back({mesh().points[facet.points[0]], mesh().points[facet.points[1]]});
    for (int cell = 0; cell < static_cast<int>(mesh().cells.size()); ++cell)
      area += cell_measure(mesh(), cell);
    visit_near_pairs(sides, 0, [&](std::size_t i, std::size_t j) {
      const auto &a = mesh().boundary[i].points, &b = mesh().boundary[j].points;
      const bool neighbours = a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
      if (!neighbours && segments_meet(sides[i], sides[j]))
        fail("the boundary of the mesh crosses or touches itself",
             text(FacetPoints{a[0], a[1]}) + " and " + text(FacetPoints{b[0], b[1]}),
             "cells that share edges and corners alone", 0);
      return true;
    });
    double covered = 0;
    for (const auto& part : lay_over({sides}).parts) covered += part.area;
    if (std::abs(covered - area) > 1e-6 * area)
      fail("cells of the mesh lie over one another",
           "cells of " + std::to_string(area) + " cm^2 that cover " + std::to_string(covered) + " cm^2",
           "cells that share edges and corners alone", 0);
  }

  /// Facets of physical groups by their points.
  void collect_named_facets() {
    std::map<int, int> tag_of_group;
    for (const auto& [key, name] : content_.physical_names)
      if (key.first == dim - 1) {
        tag_of_group[key.second] = static_cast<int>(mesh().boundary_names.size());
        mesh().boundary_names.push_back(name);
      }
    for (const auto& element : content_.elements) {
      if (gmsh_simplex_dimension(element.type) != dim - 1) continue;
      FacetPoints facet;
      bool in_mesh = true;
      for (int i = 0; i < dim; ++i) {
        const auto entry = point_of_node_.find(element.nodes[i]);
        in_mesh = in_mesh && entry != point_of_node_.end();
        if (in_mesh) facet[i] = entry->second;
      }
      if (!in_mesh) continue;
      for (const int group : element.physical) {
        const auto tag = tag_of_group.find(group);
        if (tag == tag_of_group.end())
          fail("a physical group has no name", "group " + std::to_string(group), "an entry in $PhysicalNames",
               element.line);
        const auto [entry, added] = named_facets_.emplace(sorted(facet), tag->second);
        if (!added && entry->second != tag->second)
          fail("a boundary facet is in two physical groups",
               mesh().boundary_names[entry->second] + " and " + mesh().boundary_names[tag->second],
               "one group", element.line);
      }
    }
  }

  void add_boundary() {
    std::map<FacetPoints, int> cells_of_facet;
    for (const auto& cell : mesh().cells)
      for_facets(cell, [&](const FacetPoints& facet, int) { ++cells_of_facet[sorted(facet)]; });
    for (const auto& cell : mesh().cells)
      for_facets(cell, [&](const FacetPoints& facet, int) {
        const int cells = cells_of_facet.at(sorted(facet));
        if (cells > 2) fail("a facet has more than two cells", text(facet), "a conforming mesh", 0);
        if (cells == 2) return;
        const auto name = named_facets_.find(sorted(facet));
        if (name == named_facets_.end())
          fail("a boundary facet is in no physical group", text(facet),
               "a named physical group of dimension " + std::to_string(dim - 1) + " for the whole boundary",
               0);
        mesh().boundary.push_back({facet, name->second});
      });
  }

  template <class Visit>
  static void for_facets(const Cell& cell, const Visit& visit) {
    for (int opposite = 0; opposite <= dim; ++opposite) {
      FacetPoints facet;
      for (int i = 0, k = 0; i <= dim; ++i)
        if (i != opposite) facet[k++] = cell[i];
      visit(facet, opposite);
    }
  }

  std::string text(const FacetPoints& facet) const {
    std::ostringstream out;
    out << "facet";
    for (const int i : facet) out << " (" << imported_.mesh.points[i].transpose() << ") cm";
    return out.str();
  }

  static std::string place(const Point<3>& x) {
    std::ostringstream out;
    out << "(" << x.transpose() << ") cm";
    return out.str();
  }

  SimplexMesh<dim>& mesh() { return imported_.mesh; }
  const SimplexMesh<dim>& mesh() const { return imported_.mesh; }

  std::filesystem::path file_;
  GmshFile content_;
  double flat_tolerance_ = 0; ///< cm
  std::map<long, int> point_of_node_;
  std::vector<int> lines_;                  ///< of the cells in the file
  std::map<FacetPoints, int> named_facets_; ///< sorted points -> boundary tag
  ImportedMesh<dim> imported_;
};

} // namespace

template <int dim>
ImportedMesh<dim> import_gmsh(const std::filesystem::path& file, double cm_per_unit) {
  return Importer<dim>(file, cm_per_unit).run();
}

template ImportedMesh<2> import_gmsh<2>(const std::filesystem::path&, double);
template ImportedMesh<3> import_gmsh<3>(const std::filesystem::path&, double);

} // namespace undula::geometry
