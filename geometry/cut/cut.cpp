#include "geometry/cut/cut.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/cut/cut_checks.hpp"
#include "geometry/cut/cut_reproducer.hpp"
#include "geometry/cut/exact/exact_cells.hpp"
#include "geometry/cut/plane/fluid_polygons.hpp"
#include "geometry/mesh/polygons.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

template <int dim>
class Cutter {
public:
  using Setup = typename BackgroundCutter<dim>::Setup;

  Cutter(const Setup& setup, std::span<const SimplexMesh<dim>> solids)
      : setup_(setup),
        solids_(solids),
        options_(setup.options),
        filtered_(dim == 2 && !setup.options.exact),
        exact_(setup, solids) {
    cut_.mesh = setup.mesh;
    cut_.facets = setup.facets;
  }

  CutMesh<dim> run() {
    check_placed_solids(solids_);
    find_near_cells();
    cut_.cell_parts.push_back(0);
    for (int cell = 0; cell < static_cast<int>(cut_.mesh.cells.size()); ++cell) {
      if (exact_.has(cell) || !add_filtered_parts(cell)) add_exact_parts(cell);
      cut_.cell_parts.push_back(static_cast<int>(cut_.parts.size()));
    }
    for (int facet = 0; facet < static_cast<int>(cut_.facets.facets.size()); ++facet) {
      const bool inner = cut_.facets.facets[facet].cells[1] >= 0;
      if (filtered_ && !both_exact(facet))
        inner ? connect_stretches(facet) : add_boundary_stretches(facet);
      else
        inner ? connect(facet) : add_boundary(facet);
    }
    if (const auto open = first_open_cell(cut_, setup_, closed_cells_))
      fail(*open, exact_.near_solid_cells(*open),
           "a fluid part of an element is not closed (do solids overlap?)");
    cut_.exact_cells = exact_.count();
    return std::move(cut_);
  }

private:
  void find_near_cells() {
    const int cells = static_cast<int>(cut_.mesh.cells.size());
    if constexpr (dim == 2) {
      const auto placed = place_skin(setup_.skin, solids_);
      const auto touching = touching_segments(setup_.skin, placed);
      if (filtered_) {
        placed_ = placed;
        trace_ = trace_skin(*setup_.index, setup_.skin, placed_, touching);
        for (int cell = 0; cell < cells; ++cell)
          if (trace_.uncertain[cell]) cut_exactly(cell);
        check_turns();
        find_sides();
        stretch_parts_.fill(std::vector<int>(cut_.facets.facets.size() + trace_.crossings.size(), -1));
        return;
      }
    }
    for (int cell = 0; cell < cells; ++cell)
      if (!exact_.near_solid_cells(cell).empty()) cut_exactly(cell);
  }

  void cut_exactly(int cell) {
    exact_.cut(cell);
    closed_cells_.push_back(cell);
  }

  void add_whole(int cell) { cut_.parts.push_back({cell, false, cell_measure(cut_.mesh, cell)}); }

  void add_exact_parts(int cell) {
    if (!exact_.has(cell)) {
      if (!filtered_) return add_whole(cell);
      cut_exactly(cell);
    }
    const auto& near = exact_.at(cell);
    const auto& shape = near.shape;
    const int first = static_cast<int>(cut_.parts.size());
    const bool is_cut = !shape.removed.empty();
    for (int part = 0; part < shape.part_count; ++part) {
      if (!is_cut) {
        add_whole(cell);
        continue;
      }
      cut_.parts.push_back({cell, true});
      add_volume(shape, part, cut_.parts.back());
    }
    double sum = 0;
    for (std::size_t part = first; part < cut_.parts.size(); ++part) sum += cut_.parts[part].measure;
    if (const auto error = error_of_sum(near, sum, setup_, solids_, exact_.table()); !error.empty())
      fail(cell, near.solid_cells, error);
    for (std::size_t i = 0; i < shape.pieces.size(); ++i)
      add_interface(shape.pieces[i], first + shape.part_of_piece[i]);
  }

  // False if the cell has to be cut in exact arithmetic.
  bool add_filtered_parts(int cell) {
    if (!filtered_) return false;
    if constexpr (dim == 2) {
      if (trace_.first_chain[cell] < 0) {
        if (side_of_point_[cut_.mesh.cells[cell][0]] == Side::fluid) {
          for (int v = 0; v <= dim; ++v) set_stretch(cell, v, 0, static_cast<int>(cut_.parts.size()));
          add_whole(cell);
        }
        return true;
      }
      if (!find_fluid_polygons(*setup_.index, trace_, cell, polygons_)) fail_overlap(cell);
      const double element = cell_measure(cut_.mesh, cell);
      if (!(std::abs(polygons_.fluid_area + polygons_.solid_area - element) <= closure_tolerance * element))
        fail_overlap(cell);
      const std::size_t begin = cut_.simplices.size();
      std::array<int, 8> ends;
      if (polygons_.count > static_cast<int>(ends.size())) return false;
      for (int p = 0; p < polygons_.count; ++p) {
        if (!triangulate_polygon(polygons_.corners[p], cut_.simplices) ||
            static_cast<int>(cut_.simplices.size()) == (p ? ends[p - 1] : static_cast<int>(begin))) {
          cut_.simplices.resize(begin);
          return false;
        }
        ends[p] = static_cast<int>(cut_.simplices.size());
      }
      const int first = static_cast<int>(cut_.parts.size());
      auto& quadrature = cut_.volume_quadrature;
      int simplex = static_cast<int>(begin);
      for (int p = 0; p < polygons_.count; ++p) {
        auto& part = cut_.parts.emplace_back(FluidPart{cell, true});
        part.simplex_begin = simplex;
        part.quadrature_begin = static_cast<int>(quadrature.weights.size());
        for (; simplex < ends[p]; ++simplex)
          append_simplex_quadrature<dim, dim>(setup_.volume_rule, cut_.simplices[simplex], quadrature);
        part.simplex_end = simplex;
        part.quadrature_end = static_cast<int>(quadrature.weights.size());
        part.measure = std::accumulate(quadrature.weights.begin() + part.quadrature_begin,
                                       quadrature.weights.end(), 0.0);
      }
      for (const auto& stretch : polygons_.stretches)
        set_stretch(cell, stretch.local, stretch.index, first + stretch.polygon);
      for (const auto& chain : polygons_.chains) add_skin(trace_.chains[chain.chain], first + chain.polygon);
      closed_cells_.push_back(cell);
      ++cut_.filtered_cells;
    }
    return true;
  }

  void add_skin(const SkinChain& chain, int part) {
    if constexpr (dim == 2) {
      for (int i = chain.first; i >= 0; i = trace_.pieces[i].next) {
        const auto& piece = trace_.pieces[i];
        const auto& segment = setup_.skin.segments[piece.segment];
        const Point<2> along = (placed_[piece.segment].b - placed_[piece.segment].a).normalized();
        InterfacePiece<2> record{part, segment.solid, segment.cell, Point<2>(-along[1], along[0]), 0, 0};
        auto& set = cut_.interface_quadrature;
        record.quadrature_begin = static_cast<int>(set.weights.size());
        append_simplex_quadrature<2, 1>(setup_.interface_rule, std::array{piece.from, piece.to}, set);
        record.quadrature_end = static_cast<int>(set.weights.size());
        cut_.interface.push_back(record);
      }
    }
  }

  bool both_exact(int facet) const {
    const auto& cells = cut_.facets.facets[facet].cells;
    return exact_.has(cells[0]) && (cells[1] < 0 || exact_.has(cells[1]));
  }

  // First of the stretches of a facet, the pieces between its crossings from low to high.
  int first_stretch(int facet) const { return facet + trace_.facet_crossings[facet]; }

  void set_stretch(int cell, int local, int index, int part) {
    const int facet = cut_.facets.cell_facets[cell][local];
    stretch_parts_[cut_.facets.facets[facet].cells[0] == cell ? 0 : 1][first_stretch(facet) + index] = part;
  }

  // Along a facet fluid and solid must take turns.
  void check_turns() {
    for (int facet = 0; facet < static_cast<int>(cut_.facets.facets.size()); ++facet)
      for (int i = 0; i + 1 < trace_.count(facet); ++i)
        if (!both_exact(facet) && trace_.at(facet, i).fluid_after == trace_.at(facet, i + 1).fluid_after)
          fail_overlap(cut_.facets.facets[facet].cells[0]);
  }

  enum class Side : char { unknown, fluid, solid };

  // On which side of the skin the points of the background lie: from the crossings on the facets, and along
  // facets without any. Points on the skin have cells in exact arithmetic only, and stay unknown.
  void find_sides() {
    if constexpr (dim == 2) {
      const auto& index = *setup_.index;
      const int facets = static_cast<int>(cut_.facets.facets.size());
      side_of_point_.assign(cut_.mesh.points.size(), Side::unknown);
      std::vector<int> front;
      const auto set = [&](int point, bool fluid, int facet) {
        const Side side = fluid ? Side::fluid : Side::solid;
        if (side_of_point_[point] == side) return;
        if (side_of_point_[point] != Side::unknown) fail_overlap(cut_.facets.facets[facet].cells[0]);
        side_of_point_[point] = side;
        front.push_back(point);
      };
      const auto spread = [&] {
        while (!front.empty()) {
          const int point = front.back();
          front.pop_back();
          for (int i = index.first_facet_of_point[point]; i < index.first_facet_of_point[point + 1]; ++i) {
            const int facet = index.facets_of_points[i];
            if (trace_.count(facet) > 0 || both_exact(facet)) continue;
            const int other = index.low(facet) == point ? index.high(facet) : index.low(facet);
            set(other, side_of_point_[point] == Side::fluid, facet);
          }
        }
      };
      for (int facet = 0; facet < facets; ++facet) {
        if (both_exact(facet)) continue;
        if (const int n = trace_.count(facet); n > 0) {
          set(index.low(facet), !trace_.at(facet, 0).fluid_after, facet);
          set(index.high(facet), trace_.at(facet, n - 1).fluid_after, facet);
          continue;
        }
        for (int k : {0, 1})
          if (const int cell = cut_.facets.facets[facet].cells[k]; cell >= 0 && exact_.has(cell))
            set(index.low(facet), !exact_.at(cell).traces[cut_.facets.facets[facet].local[k]].empty(), facet);
      }
      spread();
      // What no skin reaches is all fluid or all solid.
      for (int cell = 0; cell < static_cast<int>(cut_.mesh.cells.size()); ++cell) {
        if (exact_.has(cell) || trace_.first_chain[cell] >= 0) continue;
        if (side_of_point_[cut_.mesh.cells[cell][0]] != Side::unknown) continue;
        const auto near = exact_.near_solid_cells(cell);
        const bool fluid =
            near.empty() || cut_cell(exact_.table(), cell, std::span<const SolidCell>(near)).part_count > 0;
        set(cut_.mesh.cells[cell][0], fluid, cut_.facets.cell_facets[cell][2]);
        spread();
      }
    }
  }

  void add_volume(const CellCut<dim>& shape, int part, FluidPart& record) {
    auto& quadrature = cut_.volume_quadrature;
    record.quadrature_begin = static_cast<int>(quadrature.weights.size());
    record.simplex_begin = static_cast<int>(cut_.simplices.size());
    for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
      if (shape.part_of_piece[i] != part) continue;
      for (const auto& simplex : triangulate<dim, dim>(shape.pieces[i])) {
        append_simplex_quadrature<dim, dim>(setup_.volume_rule, simplex, quadrature);
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
      const auto [mesh, index] = exact_.table().origin(side.plane);
      if (mesh == 0 || side.positive) continue; // hyperplanes point into the first cell of their facet
      const auto& facet = exact_.table().facets(mesh).facets[index];
      if (facet.cells[1] >= 0) continue;
      auto contact = facet_in(piece, side.plane);
      if (!contact) continue;
      std::vector<HalfSpace> extent;
      for (const auto& solid_side : exact_.table().sides(mesh, facet.cells[0]))
        if (solid_side.plane != side.plane) extent.push_back(solid_side);
      contact = intersect<dim>(std::move(*contact), extent, exact_.table());
      if (!contact) continue;
      InterfacePiece<dim> record{part, mesh - 1, facet.cells[0], {}, 0, 0};
      // The barycentric coordinate of the opposite vertex rises into the solid.
      record.normal =
          barycentric_gradients(exact_.table().mesh(mesh), facet.cells[0]).col(facet.local[0]).normalized();
      std::tie(record.quadrature_begin, record.quadrature_end) =
          add_facet_quadrature({*contact}, setup_.interface_rule, cut_.interface_quadrature);
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
    add_facet_quadrature({shape}, setup_.boundary_rule, set);
    return std::accumulate(set.weights.begin(), set.weights.end(), 0.0);
  }

  std::array<Point<dim>, dim> facet_points(int facet) const {
    std::array<Point<dim>, dim> points;
    for (int i = 0; i < dim; ++i) points[i] = cut_.mesh.points[cut_.facets.facets[facet].points[i]];
    return points;
  }

  // Traces of a cell on its facet; null for a cell whose one part covers the facet whole.
  const std::vector<FacetTrace<dim>>* traces(int cell, int local) const {
    const bool whole =
        cut_.cell_parts[cell + 1] - cut_.cell_parts[cell] == 1 && !cut_.parts[cut_.cell_parts[cell]].cut;
    return whole ? nullptr : &exact_.at(cell).traces[local];
  }

  /// Adds `measure` to what two parts share of a facet, whose connections start at `begin`.
  void add_connection(std::size_t begin, int facet, std::array<int, 2> parts, double measure) {
    for (std::size_t c = begin; c < cut_.connections.size(); ++c) {
      auto& known = cut_.connections[c];
      if (known.part[0] != parts[0] || known.part[1] != parts[1]) continue;
      known.measure += measure;
      return;
    }
    cut_.connections.push_back({facet, {parts[0], parts[1]}, measure});
  }

  void connect(int index) {
    const auto& facet = cut_.facets.facets[index];
    const std::vector<FacetTrace<dim>>* sides[2] = {traces(facet.cells[0], facet.local[0]),
                                                    traces(facet.cells[1], facet.local[1])};
    const int first_part[2] = {cut_.cell_parts[facet.cells[0]], cut_.cell_parts[facet.cells[1]]};
    const std::size_t begin = cut_.connections.size();
    const auto add = [&](int part_0, int part_1, double measure) {
      add_connection(begin, index, {part_0, part_1}, measure);
    };
    if (!sides[0] && !sides[1]) {
      add(first_part[0], first_part[1], setup_.shapes[index].measure);
    } else if (!sides[0]) {
      for (const auto& trace : *sides[1])
        add(first_part[0], first_part[1] + trace.part, measure_of(trace.shape));
    } else if (!sides[1]) {
      for (const auto& trace : *sides[0])
        add(first_part[0] + trace.part, first_part[1], measure_of(trace.shape));
    } else {
      for (const auto& a : *sides[0])
        for (const auto& b : *sides[1])
          if (const auto shared = intersect<dim>(a.shape, b.shape.sides, exact_.table()))
            add(first_part[0] + a.part, first_part[1] + b.part, measure_of(*shared));
    }
  }

  // Part on each stretch of a facet (-1: solid), seen from one of its cells.
  std::vector<int> parts_on_stretches(int facet, int k) const {
    const int count = trace_.count(facet) + 1;
    const int cell = cut_.facets.facets[facet].cells[k];
    if (!exact_.has(cell)) {
      const auto begin = stretch_parts_[k].begin() + first_stretch(facet);
      return {begin, begin + count};
    }
    // The exact traces, in order, merged where they meet; there is one on every fluid stretch.
    if constexpr (dim == 2) {
      const auto& low = cut_.mesh.points[setup_.index->low(facet)];
      const auto& high = cut_.mesh.points[setup_.index->high(facet)];
      const int axis = std::abs(high[0] - low[0]) >= std::abs(high[1] - low[1]) ? 0 : 1;
      const bool rising = high[axis] > low[axis];
      struct Run {
        Exact begin, end;
        int part;
      };
      std::vector<Run> runs;
      for (const auto& trace : exact_.at(cell).traces[cut_.facets.facets[facet].local[k]]) {
        Exact a = trace.shape.vertices[0].x[axis], b = trace.shape.vertices[1].x[axis];
        if (!rising) {
          a = -a;
          b = -b;
        }
        runs.push_back({std::min(a, b), std::max(a, b), cut_.cell_parts[cell] + trace.part});
      }
      std::sort(runs.begin(), runs.end(), [](const Run& p, const Run& q) { return p.begin < q.begin; });
      std::vector<int> merged;
      for (std::size_t r = 0; r < runs.size(); ++r)
        if (r == 0 || runs[r].part != runs[r - 1].part || runs[r].begin != runs[r - 1].end)
          merged.push_back(runs[r].part);
      const bool fluid_first = count == 1 ? !merged.empty() : !trace_.at(facet, 0).fluid_after;
      std::vector<int> parts(count, -1);
      std::size_t next = 0;
      for (int i = fluid_first ? 0 : 1; i < count; i += 2)
        parts[i] = next < merged.size() ? merged[next++] : -2;
      if (next != merged.size()) parts[0] = -2; // as many traces as fluid stretches, or they do not match
      return parts;
    } else {
      return {};
    }
  }

  double stretch_measure(int facet, int index) const {
    const int last = trace_.count(facet);
    const double begin = index == 0 ? 0 : trace_.at(facet, index - 1).t;
    const double end = index == last ? 1 : trace_.at(facet, index).t;
    return (end - begin) * setup_.shapes[facet].measure;
  }

  void connect_stretches(int facet) {
    const std::size_t begin = cut_.connections.size();
    const auto add = [&](int part_0, int part_1, double measure) {
      add_connection(begin, facet, {part_0, part_1}, measure);
    };
    const auto& cells = cut_.facets.facets[facet].cells;
    if (!exact_.has(cells[0]) && !exact_.has(cells[1])) {
      for (int i = 0; i <= trace_.count(facet); ++i) {
        const int stretch = first_stretch(facet) + i;
        const int a = stretch_parts_[0][stretch], b = stretch_parts_[1][stretch];
        if ((a < 0) != (b < 0)) fail_overlap(cells[0]);
        if (a >= 0) add(a, b, stretch_measure(facet, i));
      }
      return;
    }
    const auto first = parts_on_stretches(facet, 0), second = parts_on_stretches(facet, 1);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if ((first[i] < 0) != (second[i] < 0) || first[i] < -1 || second[i] < -1) fail_overlap(cells[0]);
      if (first[i] >= 0) add(first[i], second[i], stretch_measure(facet, static_cast<int>(i)));
    }
  }

  void add_boundary_stretches(int index) {
    const auto& facet = cut_.facets.facets[index];
    auto& quadrature = cut_.boundary_quadrature;
    const int cell = facet.cells[0];
    for (int part = cut_.cell_parts[cell]; part < cut_.cell_parts[cell + 1]; ++part) {
      BoundaryPiece piece{index, part, facet.boundary_tag, static_cast<int>(quadrature.weights.size()), 0};
      if constexpr (dim == 2) {
        const int last = trace_.count(index);
        for (int i = 0; i <= last; ++i) {
          if (stretch_parts_[0][first_stretch(index) + i] != part) continue;
          const auto& begin = i == 0 ? cut_.mesh.points[setup_.index->low(index)] : trace_.at(index, i - 1).x;
          const auto& end = i == last ? cut_.mesh.points[setup_.index->high(index)] : trace_.at(index, i).x;
          append_simplex_quadrature<2, 1>(setup_.boundary_rule, std::array{begin, end}, quadrature);
        }
      }
      piece.quadrature_end = static_cast<int>(quadrature.weights.size());
      if (piece.quadrature_end > piece.quadrature_begin) cut_.boundary.push_back(piece);
    }
  }

  void add_boundary(int index) {
    const auto& facet = cut_.facets.facets[index];
    const int cell = facet.cells[0];
    auto& quadrature = cut_.boundary_quadrature;
    for (int part = cut_.cell_parts[cell]; part < cut_.cell_parts[cell + 1]; ++part) {
      BoundaryPiece piece{index, part, facet.boundary_tag, static_cast<int>(quadrature.weights.size()), 0};
      if (!exact_.has(cell)) {
        append_simplex_quadrature<dim, dim - 1>(setup_.boundary_rule, facet_points(index), quadrature);
      } else {
        const auto& near = exact_.at(cell);
        std::vector<Polytope<dim>> wet;
        for (const auto& trace : near.traces[facet.local[0]])
          if (cut_.cell_parts[cell] + trace.part == part) wet.push_back(trace.shape);
        add_facet_quadrature(uncovered(std::move(wet), near), setup_.boundary_rule, quadrature);
      }
      piece.quadrature_end = static_cast<int>(quadrature.weights.size());
      if (piece.quadrature_end > piece.quadrature_begin) cut_.boundary.push_back(piece);
    }
  }

  // Where a solid lies against the boundary from outside, the fluid meets its skin and not the boundary.
  std::vector<Polytope<dim>> uncovered(std::vector<Polytope<dim>> shapes, const ExactCell<dim>& near) {
    for (const auto& solid : near.solid_cells) {
      const auto sides = exact_.table().sides(mesh_of_solid(solid.solid), solid.cell);
      std::vector<Polytope<dim>> rest;
      for (const auto& shape : shapes)
        for (auto& piece : subtract(shape, sides, exact_.table())) rest.push_back(std::move(piece));
      shapes = std::move(rest);
    }
    return shapes;
  }

  [[noreturn]] void fail_overlap(int cell) {
    fail(cell, exact_.near_solid_cells(cell), "the skins of solids do not part fluid from solid");
  }

  [[noreturn]] void fail(int cell, std::span<const SolidCell> solid_cells, const std::string& what) const {
    const auto path = std::filesystem::path(options_.reproducer_directory) /
                      ("cut_failure_cell_" + std::to_string(cell) + ".txt");
    write_reproducer(make_reproducer<dim>(cut_.mesh, cell, solids_, solid_cells, options_), path.string());
    throw NumericsError(
        "cutting the background mesh failed: " + what,
        "background cell " + std::to_string(cell) + ", reproducer " + path.string(),
        "solids that do not overlap each other or themselves; report the reproducer otherwise");
  }

  const Setup& setup_;
  std::span<const SimplexMesh<dim>> solids_;
  const CutOptions& options_;
  CutMesh<dim> cut_;
  bool filtered_;                 // cells that can be are cut in floating point
  std::vector<int> closed_cells_; // cells whose parts have to be closed

  ExactCells<dim> exact_;

  // Floating point.
  std::vector<PlacedSegment> placed_;
  SkinTrace trace_;
  std::vector<Side> side_of_point_;
  std::array<std::vector<int>, 2> stretch_parts_; // [side of facet][stretch] -> part, -1 if solid
  FluidPolygons polygons_;
};

} // namespace

template <int dim>
BackgroundCutter<dim>::BackgroundCutter(SimplexMesh<dim> background, std::span<const SimplexMesh<dim>> solids,
                                        const CutOptions& options)
    : setup_(std::make_shared<const Setup>(std::move(background), solids, options)) {}

template <int dim>
CutMesh<dim> BackgroundCutter<dim>::cut(std::span<const SimplexMesh<dim>> solids) const {
  bool same = solids.size() == setup_->solid_cells.size();
  for (std::size_t s = 0; s < solids.size() && same; ++s)
    same = solids[s].points.size() == setup_->solid_points[s] && solids[s].cells == setup_->solid_cells[s];
  if (!same)
    throw InputError("the solids that cut the background are not those that it was prepared for",
                     std::to_string(solids.size()) + " solids", "the same meshes, with their points moved",
                     "BackgroundCutter::cut");
  return Cutter<dim>(*setup_, solids).run();
}

template <int dim>
const CutOptions& BackgroundCutter<dim>::options() const {
  return setup_->options;
}

template <int dim>
CutMesh<dim> cut_mesh(const SimplexMesh<dim>& background, std::span<const SimplexMesh<dim>> solids,
                      const CutOptions& options) {
  return BackgroundCutter<dim>(background, solids, options).cut(solids);
}

template class BackgroundCutter<2>;
template class BackgroundCutter<3>;
template CutMesh<2> cut_mesh<2>(const SimplexMesh<2>&, std::span<const SimplexMesh<2>>, const CutOptions&);
template CutMesh<3> cut_mesh<3>(const SimplexMesh<3>&, std::span<const SimplexMesh<3>>, const CutOptions&);

} // namespace undula::geometry
