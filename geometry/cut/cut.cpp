#include "geometry/cut/cut.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>

#include "geometry/cut/cut_checks.hpp"
#include "geometry/cut/cut_reproducer.hpp"
#include "geometry/cut/exact/exact_parts.hpp"
#include "geometry/cut/plane/plane_cut.hpp"
#include "geometry/cut/space/space_cut.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

/// One cut. What can be is decided in floating point, by PlaneCut or SpaceCut, the rest in exact arithmetic.
template <int dim>
class Cutter {
public:
  using Setup = typename BackgroundCutter<dim>::Setup;
  using Filtered = std::conditional_t<dim == 2, PlaneCut, SpaceCut>;

  Cutter(const Setup& setup, std::span<const SimplexMesh<dim>> solids)
      : setup_(setup), solids_(solids), options_(setup.options), exact_(setup, solids) {
    cut_.mesh = setup.mesh;
    cut_.facets = setup.facets;
  }

  CutMesh<dim> run() {
    check_placed_solids(solids_);
    try {
      find_near_cells();
      add_parts();
      for (int facet = 0; facet < static_cast<int>(cut_.facets.facets.size()); ++facet) add_facet(facet);
    } catch (const CutContradiction& contradiction) {
      fail(contradiction.cell, exact_.near_solid_cells(contradiction.cell), contradiction.what);
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
    if (options_.exact) {
      if constexpr (dim == 2) touching_segments(setup_.skin, place_skin(setup_.skin, solids_));
      for (int cell = 0; cell < cells; ++cell)
        if (!exact_.near_solid_cells(cell).empty()) cut_exactly(cell);
      return;
    }
    filtered_.emplace(setup_, solids_);
    for (int cell = 0; cell < cells; ++cell)
      if (filtered_->uncertain()[cell]) cut_exactly(cell);
    check_turns();
    find_sides();
  }

  void cut_exactly(int cell) {
    exact_.cut(cell);
    closed_cells_.push_back(cell);
  }

  void add_parts() {
    cut_.cell_parts.push_back(0);
    for (int cell = 0; cell < static_cast<int>(cut_.mesh.cells.size()); ++cell) {
      if (exact_.has(cell)) {
        add_exact(cell);
      } else if (!filtered_) {
        add_whole(cut_, cell);
      } else if (!filtered_->add_parts(cell, side_of_point_, cut_)) {
        cut_exactly(cell);
        add_exact(cell);
      } else if (filtered_->passes_through(cell)) {
        closed_cells_.push_back(cell);
        ++cut_.filtered_cells;
      }
      cut_.cell_parts.push_back(static_cast<int>(cut_.parts.size()));
    }
  }

  void add_exact(int cell) {
    const auto& near = exact_.at(cell);
    const std::size_t first = cut_.parts.size();
    add_exact_parts(near, exact_.table(), setup_, cut_);
    double sum = 0;
    for (std::size_t part = first; part < cut_.parts.size(); ++part) sum += cut_.parts[part].measure;
    if (const auto error = error_of_sum(near, sum, setup_, solids_); !error.empty())
      fail(cell, near.solid_cells, error);
  }

  void add_facet(int facet) {
    const bool inner = cut_.facets.facets[facet].cells[1] >= 0;
    if (filtered_ && !both_exact(facet))
      inner ? filtered_->connect(facet, exact_, cut_) : filtered_->add_boundary(facet, cut_);
    else
      inner ? connect_exact(facet, exact_, setup_, cut_) : add_exact_boundary(facet, exact_, setup_, cut_);
  }

  bool both_exact(int facet) const {
    const auto& cells = cut_.facets.facets[facet].cells;
    return exact_.has(cells[0]) && (cells[1] < 0 || exact_.has(cells[1]));
  }

  // Whether a cell around an edge is cut in floating point, so that the crossings of the edge are certain.
  bool is_certain(std::span<const int> cells_around) const {
    return std::any_of(cells_around.begin(), cells_around.end(),
                       [&](int cell) { return cell >= 0 && !exact_.has(cell); });
  }

  // Along an edge fluid and solid must take turns.
  void check_turns() {
    const auto& skin = *filtered_;
    for (int edge = 0; edge < skin.edges(); ++edge)
      for (int i = 0; i + 1 < skin.count(edge); ++i)
        if (skin.fluid_after(edge, i) == skin.fluid_after(edge, i + 1) && is_certain(skin.cells(edge)))
          throw CutContradiction{skin.cells(edge)[0]};
  }

  // On which side of the skin the points of the background lie: from the crossings on the edges, and along
  // edges without any. Points on the skin have cells in exact arithmetic only, and stay unknown.
  void find_sides() {
    const auto& skin = *filtered_;
    side_of_point_.assign(cut_.mesh.points.size(), Side::unknown);
    std::vector<int> front;
    const auto set = [&](int point, bool fluid, int cell) {
      const Side side = fluid ? Side::fluid : Side::solid;
      if (side_of_point_[point] == side) return;
      if (side_of_point_[point] != Side::unknown) throw CutContradiction{cell};
      side_of_point_[point] = side;
      front.push_back(point);
    };
    const auto spread = [&] {
      while (!front.empty()) {
        const int point = front.back();
        front.pop_back();
        for (const int edge : skin.edges_of(point)) {
          if (skin.count(edge) > 0 || !is_certain(skin.cells(edge))) continue;
          const int other = skin.low(edge) == point ? skin.high(edge) : skin.low(edge);
          set(other, side_of_point_[point] == Side::fluid, skin.cells(edge)[0]);
        }
      }
    };
    for (int edge = 0; edge < skin.edges(); ++edge)
      if (const int n = skin.count(edge); n > 0 && is_certain(skin.cells(edge))) {
        set(skin.low(edge), !skin.fluid_after(edge, 0), skin.cells(edge)[0]);
        set(skin.high(edge), skin.fluid_after(edge, n - 1), skin.cells(edge)[0]);
      }
    for (int f = 0; f < static_cast<int>(cut_.facets.facets.size()); ++f) {
      const auto& facet = cut_.facets.facets[f];
      if (both_exact(f) || skin.meets_facet(f)) continue;
      for (int k : {0, 1})
        if (const int cell = facet.cells[k]; cell >= 0 && exact_.has(cell))
          set(facet.points[0], !exact_.at(cell).traces[facet.local[k]].empty(), facet.cells[0]);
    }
    spread();
    // What no skin reaches is all fluid or all solid.
    for (int cell = 0; cell < static_cast<int>(cut_.mesh.cells.size()); ++cell) {
      if (exact_.has(cell) || skin.passes_through(cell)) continue;
      const int point = cut_.mesh.cells[cell][0];
      if (side_of_point_[point] != Side::unknown) continue;
      const auto near = exact_.near_solid_cells(cell);
      const bool fluid =
          near.empty() || cut_cell(exact_.table(), cell, std::span<const SolidCell>(near)).part_count > 0;
      set(point, fluid, cell);
      spread();
    }
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
  std::optional<Filtered> filtered_; // cells in floating point, if any is to be
  ExactCells<dim> exact_;
  std::vector<int> closed_cells_; // cells whose parts have to be closed
  std::vector<Side> side_of_point_;
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
