#include "geometry/cut.hpp"

#include <cmath>
#include <filesystem>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "geometry/cut_cell.hpp"
#include "geometry/cut_reproducer.hpp"

namespace undula {
namespace {

constexpr double closure_tolerance = 1e-10; // relative, beyond it an element has failed

template <int dim>
class Cutter {
public:
  Cutter(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
         const CutOptions& options)
      : solids_(solids),
        options_(options),
        cut_{background, build_facet_table(background), {}, {0}, {}, {}, {}, {}, {}, {}, {}},
        volume_rule_(reference_rule<dim>(options.volume_degree)),
        interface_rule_(reference_rule<dim - 1>(options.interface_degree)),
        boundary_rule_(reference_rule<dim - 1>(options.boundary_degree)),
        solid_facets_(facet_tables(solids)),
        table_(hyperplanes()),
        grid_(solid_boxes()),
        near_index_(background.cells.size(), -1) {}

  CutMesh<dim> run() {
    for (int cell = 0; cell < static_cast<int>(cut_.mesh.cells.size()); ++cell) {
      add_parts(cell);
      cut_.cell_parts.push_back(static_cast<int>(cut_.parts.size()));
    }
    for (int facet = 0; facet < static_cast<int>(cut_.facets.facets.size()); ++facet) {
      if (cut_.facets.facets[facet].cells[1] >= 0)
        connect(facet);
      else
        add_boundary(facet);
    }
    check_closure();
    return std::move(cut_);
  }

private:
  // A trace of a fluid part on a facet of its cell, convex.
  struct Trace {
    int part;
    Polytope<dim> shape;
  };
  // What is kept of a cell near a solid until its facets are done.
  struct NearCell {
    int cell;
    std::vector<SolidCell> solid_cells;
    std::array<std::vector<Trace>, dim + 1> traces; // by opposite vertex
  };

  static std::vector<FacetTable<dim>> facet_tables(std::span<const SimplexMesh<dim>> meshes) {
    std::vector<FacetTable<dim>> tables;
    for (const auto& mesh : meshes) tables.push_back(build_facet_table(mesh));
    return tables;
  }

  HyperplaneTable<dim> hyperplanes() const {
    std::vector<const SimplexMesh<dim>*> meshes{&cut_.mesh};
    std::vector<const FacetTable<dim>*> facets{&cut_.facets};
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      meshes.push_back(&solids_[s]);
      facets.push_back(&solid_facets_[s]);
    }
    return HyperplaneTable<dim>(std::move(meshes), std::move(facets));
  }

  std::vector<Box<dim>> solid_boxes() {
    std::vector<Box<dim>> boxes;
    for (int s = 0; s < static_cast<int>(solids_.size()); ++s) {
      for (int c = 0; c < static_cast<int>(solids_[s].cells.size()); ++c) {
        all_solid_cells_.push_back({s, c});
        boxes.push_back(cell_box(solids_[s], c));
      }
    }
    return boxes;
  }

  void add_parts(int cell) {
    std::vector<SolidCell> near;
    for (const int i : grid_.touching(cell_box(cut_.mesh, cell))) near.push_back(all_solid_cells_[i]);
    const double measure = cell_measure(cut_.mesh, cell);
    if (near.empty()) {
      cut_.parts.push_back({cell, false, measure});
      return;
    }
    const CellCut<dim> shape = cut_cell(table_, cell, std::span<const SolidCell>(near));
    near_index_[cell] = static_cast<int>(near_.size());
    auto& near_cell = near_.emplace_back(NearCell{cell, std::move(near), {}});
    const int first = static_cast<int>(cut_.parts.size());
    const bool is_cut = !shape.removed.empty();
    for (int part = 0; part < shape.part_count; ++part) {
      cut_.parts.push_back({cell, is_cut, is_cut ? 0 : measure});
      if (is_cut) add_volume(shape, part, cut_.parts.back());
    }
    check_sum(near_cell, shape, first);
    for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
      const int part = first + shape.part_of_piece[i];
      add_interface(shape.pieces[i], part);
      for (int v = 0; v <= dim; ++v)
        if (auto trace = facet_in(shape.pieces[i], table_.plane(0, cut_.facets.cell_facets[cell][v])))
          near_cell.traces[v].push_back({part, std::move(*trace)});
    }
  }

  void add_volume(const CellCut<dim>& shape, int part, FluidPart& record) {
    auto& quadrature = cut_.volume_quadrature;
    record.quadrature_begin = static_cast<int>(quadrature.weights.size());
    record.simplex_begin = static_cast<int>(cut_.simplices.size());
    for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
      if (shape.part_of_piece[i] != part) continue;
      for (const auto& simplex : triangulate<dim, dim>(shape.pieces[i])) {
        append_simplex_quadrature<dim, dim>(volume_rule_, simplex, quadrature);
        cut_.simplices.push_back(simplex);
      }
    }
    record.quadrature_end = static_cast<int>(quadrature.weights.size());
    record.simplex_end = static_cast<int>(cut_.simplices.size());
    record.measure =
        std::accumulate(quadrature.weights.begin() + record.quadrature_begin, quadrature.weights.end(), 0.0);
  }

  void add_interface(const Polytope<dim>& piece, int part) {
    for (const auto& side : piece.sides) {
      const auto [mesh, index] = table_.origin(side.plane);
      if (mesh == 0 || side.positive) continue; // hyperplanes point into the first cell of their facet
      const auto& facet = table_.facets(mesh).facets[index];
      if (facet.cells[1] >= 0) continue;
      auto contact = facet_in(piece, side.plane);
      if (!contact) continue;
      std::vector<HalfSpace> extent;
      for (const auto& solid_side : table_.sides(mesh, facet.cells[0]))
        if (solid_side.plane != side.plane) extent.push_back(solid_side);
      contact = intersect<dim>(std::move(*contact), extent, table_);
      if (!contact) continue;
      InterfacePiece<dim> record{part, mesh - 1, facet.cells[0], {}, 0, 0};
      // The barycentric coordinate of the opposite vertex rises into the solid.
      record.normal =
          barycentric_gradients(table_.mesh(mesh), facet.cells[0]).col(facet.local[0]).normalized();
      std::tie(record.quadrature_begin, record.quadrature_end) =
          add_facet_quadrature({*contact}, interface_rule_, cut_.interface_quadrature);
      cut_.interface.push_back(record);
    }
  }

  std::pair<int, int> add_facet_quadrature(const std::vector<Polytope<dim>>& shapes,
                                           const ReferenceRule<dim - 1>& rule,
                                           QuadratureSet<dim>& set) const {
    const int begin = static_cast<int>(set.weights.size());
    for (const auto& shape : shapes)
      for (const auto& simplex : triangulate<dim, dim - 1>(shape))
        append_simplex_quadrature<dim, dim - 1>(rule, simplex, set);
    return {begin, static_cast<int>(set.weights.size())};
  }

  double measure_of(const Polytope<dim>& shape) const {
    QuadratureSet<dim> set;
    add_facet_quadrature({shape}, boundary_rule_, set);
    return std::accumulate(set.weights.begin(), set.weights.end(), 0.0);
  }

  std::array<Point<dim>, dim> facet_points(int facet) const {
    std::array<Point<dim>, dim> points;
    for (int i = 0; i < dim; ++i) points[i] = cut_.mesh.points[cut_.facets.facets[facet].points[i]];
    return points;
  }

  // Traces of a cell on its facet; null for a cell whose one part covers the facet whole.
  const std::vector<Trace>* traces(int cell, int local) const {
    const bool whole =
        cut_.cell_parts[cell + 1] - cut_.cell_parts[cell] == 1 && !cut_.parts[cut_.cell_parts[cell]].cut;
    return whole ? nullptr : &near_[near_index_[cell]].traces[local];
  }

  void connect(int index) {
    const auto& facet = cut_.facets.facets[index];
    const std::vector<Trace>* sides[2] = {traces(facet.cells[0], facet.local[0]),
                                          traces(facet.cells[1], facet.local[1])};
    const int first_part[2] = {cut_.cell_parts[facet.cells[0]], cut_.cell_parts[facet.cells[1]]};
    const std::size_t begin = cut_.connections.size();
    const auto add = [&](int part_0, int part_1, double measure) {
      for (std::size_t c = begin; c < cut_.connections.size(); ++c) {
        auto& known = cut_.connections[c];
        if (known.part[0] != part_0 || known.part[1] != part_1) continue;
        known.measure += measure;
        return;
      }
      cut_.connections.push_back({index, {part_0, part_1}, measure});
    };
    if (!sides[0] && !sides[1]) {
      QuadratureSet<dim> set;
      append_simplex_quadrature<dim, dim - 1>(boundary_rule_, facet_points(index), set);
      add(first_part[0], first_part[1], std::accumulate(set.weights.begin(), set.weights.end(), 0.0));
    } else if (!sides[0]) {
      for (const auto& trace : *sides[1]) add(first_part[0], trace.part, measure_of(trace.shape));
    } else if (!sides[1]) {
      for (const auto& trace : *sides[0]) add(trace.part, first_part[1], measure_of(trace.shape));
    } else {
      for (const auto& a : *sides[0])
        for (const auto& b : *sides[1])
          if (const auto shared = intersect<dim>(a.shape, b.shape.sides, table_))
            add(a.part, b.part, measure_of(*shared));
    }
  }

  void add_boundary(int index) {
    const auto& facet = cut_.facets.facets[index];
    const int cell = facet.cells[0];
    auto& quadrature = cut_.boundary_quadrature;
    for (int part = cut_.cell_parts[cell]; part < cut_.cell_parts[cell + 1]; ++part) {
      BoundaryPiece piece{index, part, facet.boundary_tag, static_cast<int>(quadrature.weights.size()), 0};
      if (near_index_[cell] < 0) {
        append_simplex_quadrature<dim, dim - 1>(boundary_rule_, facet_points(index), quadrature);
      } else {
        const auto& near = near_[near_index_[cell]];
        std::vector<Polytope<dim>> wet;
        for (const auto& trace : near.traces[facet.local[0]])
          if (trace.part == part) wet.push_back(trace.shape);
        add_facet_quadrature(uncovered(std::move(wet), near), boundary_rule_, quadrature);
      }
      piece.quadrature_end = static_cast<int>(quadrature.weights.size());
      if (piece.quadrature_end > piece.quadrature_begin) cut_.boundary.push_back(piece);
    }
  }

  // Where a solid lies against the boundary from outside, the fluid meets its skin and not the boundary.
  std::vector<Polytope<dim>> uncovered(std::vector<Polytope<dim>> shapes, const NearCell& near) const {
    for (const auto& solid : near.solid_cells) {
      const auto sides = table_.sides(mesh_of_solid(solid.solid), solid.cell);
      std::vector<Polytope<dim>> rest;
      for (const auto& shape : shapes)
        for (auto& piece : subtract(shape, sides, table_)) rest.push_back(std::move(piece));
      shapes = std::move(rest);
    }
    return shapes;
  }

  // Sum of the parts + solid = element.
  void check_sum(const NearCell& near, const CellCut<dim>& shape, int first) const {
    const double element = cell_measure(cut_.mesh, near.cell);
    double sum = 0;
    for (std::size_t part = first; part < cut_.parts.size(); ++part) sum += cut_.parts[part].measure;
    QuadratureSet<dim> solid;
    for (const auto& removed : shape.removed)
      for (const auto& simplex : triangulate<dim, dim>(removed))
        append_simplex_quadrature<dim, dim>(volume_rule_, simplex, solid);
    sum = std::accumulate(solid.weights.begin(), solid.weights.end(), sum);
    if (!(std::abs(sum - element) <= closure_tolerance * element))
      fail(near, "the parts of an element and its solid part do not add up to the element");
  }

  // Integral of the outward normal over the boundary of each part of the cells near solids: 0.
  void check_closure() const {
    std::vector<Point<dim>> sum(cut_.parts.size(), Point<dim>::Zero());
    const auto add = [&](int part, const Point<dim>& normal, double measure) {
      sum[part] += measure * normal;
    };
    const auto total = [](const QuadratureSet<dim>& set, const auto& piece) {
      return std::accumulate(set.weights.begin() + piece.quadrature_begin,
                             set.weights.begin() + piece.quadrature_end, 0.0);
    };
    const auto outward = [&](const Facet<dim>& facet, int k) -> Point<dim> {
      return -barycentric_gradients(cut_.mesh, facet.cells[k]).col(facet.local[k]).normalized();
    };
    for (const auto& piece : cut_.interface)
      add(piece.part, piece.normal, total(cut_.interface_quadrature, piece));
    for (const auto& piece : cut_.boundary)
      add(piece.part, outward(cut_.facets.facets[piece.facet], 0), total(cut_.boundary_quadrature, piece));
    for (const auto& connection : cut_.connections)
      for (int k : {0, 1})
        add(connection.part[k], outward(cut_.facets.facets[connection.facet], k), connection.measure);
    for (const auto& near : near_) {
      const double scale = std::pow(cell_diameter(cut_.mesh, near.cell), dim - 1);
      for (int part = cut_.cell_parts[near.cell]; part < cut_.cell_parts[near.cell + 1]; ++part)
        if (!(sum[part].norm() <= closure_tolerance * scale))
          fail(near, "a fluid part of an element is not closed (do solids overlap?)");
    }
  }

  [[noreturn]] void fail(const NearCell& near, const std::string& what) const {
    const auto path = std::filesystem::path(options_.reproducer_directory) /
                      ("cut_failure_cell_" + std::to_string(near.cell) + ".txt");
    write_reproducer(make_reproducer<dim>(cut_.mesh, near.cell, solids_, near.solid_cells, options_),
                     path.string());
    throw NumericsError(
        "cutting the background mesh failed: " + what,
        "background cell " + std::to_string(near.cell) + ", reproducer " + path.string(),
        "solids that do not overlap each other or themselves; report the reproducer otherwise");
  }

  std::span<const SimplexMesh<dim>> solids_;
  CutOptions options_;
  CutMesh<dim> cut_;
  ReferenceRule<dim> volume_rule_;
  ReferenceRule<dim - 1> interface_rule_;
  ReferenceRule<dim - 1> boundary_rule_;
  std::vector<FacetTable<dim>> solid_facets_;
  HyperplaneTable<dim> table_;
  std::vector<SolidCell> all_solid_cells_; // in the order of the boxes of the grid
  BoxGrid<dim> grid_;
  std::vector<int> near_index_; // [cell] -> index into near_, -1 away from solids
  std::vector<NearCell> near_;
};

} // namespace

template <int dim>
CutMesh<dim> cut_mesh(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
                      const CutOptions& options) {
  return Cutter<dim>(background, solids, options).run();
}

template CutMesh<2> cut_mesh<2>(const SimplexMesh<2>&, std::span<const SimplexMesh<2>>, const CutOptions&);
template CutMesh<3> cut_mesh<3>(const SimplexMesh<3>&, std::span<const SimplexMesh<3>>, const CutOptions&);

} // namespace undula
