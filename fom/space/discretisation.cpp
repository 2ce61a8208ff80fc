#include "fom/space/discretisation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

template <int dim>
const BoundaryCondition<dim>& condition_of(const FsiProblem<dim>& problem, int tag) {
  const std::string name = tag >= 0 && tag < static_cast<int>(problem.background.boundary_names.size())
                               ? problem.background.boundary_names[tag]
                               : "";
  const auto found = problem.boundary.find(name);
  if (found == problem.boundary.end())
    throw InputError("a part of the fluid's boundary has no condition", "'" + name + "'",
                     "a condition for every boundary name of the mesh",
                     "boundary names of the background mesh");
  return found->second;
}

/// Axis a facet is perpendicular to (an opening has to be aligned with a coordinate plane).
template <int dim>
int normal_axis(const CutMesh<dim>& cut, int facet) {
  Point<dim> low = cut.mesh.points[cut.facets.facets[facet].points[0]], high = low;
  for (const int p : cut.facets.facets[facet].points) {
    low = low.cwiseMin(cut.mesh.points[p]);
    high = high.cwiseMax(cut.mesh.points[p]);
  }
  int axis = 0;
  (high - low).minCoeff(&axis);
  return axis;
}

/// Strong conditions act only on the nodes whose own fluid part touches the boundary: a node of the wall may
/// also carry an unknown of the fluid on the far side of a solid, which the wall does not touch.
template <int dim>
void constrain_boundary(Discretisation<dim>& disc) {
  std::vector<const BoundaryCondition<dim>*> source(disc.fluid_unknowns(), nullptr);
  std::vector<char> fixed(disc.fluid_unknowns(), 0);
  using Kind = typename BoundaryCondition<dim>::Kind;
  for (const bool velocity_pass : {false, true}) // an imposed velocity prevails over symmetry and openings
    for (const auto& piece : disc.cut.boundary) {
      const auto& condition = condition_of(disc.problem, piece.tag);
      if ((condition.kind == Kind::velocity) != velocity_pass) continue;
      const auto& facet = disc.cut.facets.facets[piece.facet];
      const int axis = normal_axis(disc.cut, piece.facet);
      const auto& cell = disc.cut.mesh.cells[disc.cut.parts[piece.part].cell];
      for (int local = 0; local <= dim; ++local) {
        if (std::find(facet.points.begin(), facet.points.end(), cell[local]) == facet.points.end()) continue;
        const int node = disc.fluid_nodes.part_dofs[piece.part][local];
        for (int c = 0; c < dim; ++c) {
          const bool constrained =
              condition.kind == Kind::velocity || (condition.kind == Kind::symmetry && c == axis) ||
              (condition.kind == Kind::opening && condition.tangential_zero && c != axis);
          if (!constrained) continue;
          const int unknown = disc.velocity_unknown(node, c);
          fixed[unknown] = 1;
          source[unknown] = condition.kind == Kind::velocity ? &condition : nullptr;
        }
      }
    }
  for (int unknown = 0; unknown < disc.fluid_unknowns(); ++unknown) {
    if (!fixed[unknown]) continue;
    const int node = unknown / (dim + 1);
    disc.constrained.push_back({unknown, unknown % (dim + 1),
                                disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]], source[unknown]});
    disc.is_constrained[unknown] = 1;
  }
  if (disc.problem.pin_pressure && disc.fluid_unknowns() > 0) {
    const int unknown = disc.pressure_unknown(0);
    disc.constrained.push_back({unknown, dim, disc.cut.mesh.points[disc.fluid_nodes.dof_point[0]], nullptr});
    disc.is_constrained[unknown] = 1;
  }
}

template <int dim>
void constrain_solids(Discretisation<dim>& disc) {
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& body = disc.problem.solids[s];
    if (!body.imposed) continue;
    const auto& nodes = disc.solid_spaces[s].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!body.imposed(nodes[i])) continue;
      const int unknown = disc.solid_unknown(static_cast<int>(s), static_cast<int>(i), 0);
      disc.imposed.push_back({static_cast<int>(s), unknown, nodes[i]});
      for (int c = 0; c < dim; ++c) disc.is_constrained[unknown + c] = 1;
      if (disc.problem.holder) disc.joined.push_back(unknown + dim - 1);
    }
  }
}

/// Splits items[begin, end) between ranks [first_rank, last_rank) by the median of the longest extent.
template <int dim>
void bisect(std::span<int> items, std::span<const Point<dim>> positions, int first_rank, int last_rank,
            std::vector<int>& owner) {
  if (last_rank - first_rank == 1) {
    for (const int i : items) owner[i] = first_rank;
    return;
  }
  Point<dim> low = Point<dim>::Constant(1e300), high = -low;
  for (const int i : items) {
    low = low.cwiseMin(positions[i]);
    high = high.cwiseMax(positions[i]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle_rank = (first_rank + last_rank) / 2;
  const std::size_t middle = items.size() * (middle_rank - first_rank) / (last_rank - first_rank);
  std::nth_element(items.begin(), items.begin() + middle, items.end(), [&](int a, int b) {
    return positions[a][axis] != positions[b][axis] ? positions[a][axis] < positions[b][axis] : a < b;
  });
  bisect<dim>(items.first(middle), positions, first_rank, middle_rank, owner);
  bisect<dim>(items.subspan(middle), positions, middle_rank, last_rank, owner);
}

} // namespace

namespace {

/// Numbering and constraints for the cut, problem and solids' spaces in `disc`.
template <int dim>
void number_unknowns(Discretisation<dim>& disc) {
  disc.fluid_nodes = build_dof_sets(disc.cut);
  disc.solid_offset.assign(1, static_cast<int>(disc.fluid_nodes.dof_point.size()) * (dim + 1));
  for (const auto& space : disc.solid_spaces)
    disc.solid_offset.push_back(disc.solid_offset.back() + static_cast<int>(space.nodes.size()) * dim);
  disc.is_constrained.assign(disc.unknowns(), 0);
  constrain_boundary(disc);
  constrain_solids(disc);
}

} // namespace

template <int dim>
void constrain_rows(const Discretisation<dim>& disc, Eigen::VectorXd& values) {
  double joined = 0;
  for (const int unknown : disc.joined) joined += values[unknown];
  for (int unknown = 0; unknown < disc.unknowns(); ++unknown)
    if (disc.is_constrained[unknown]) values[unknown] = 0;
  if (!disc.joined.empty()) values[disc.joined.front()] = joined;
}

template <int dim>
Discretisation<dim> discretise(FsiProblem<dim> problem, const CutOptions& options) {
  Discretisation<dim> disc;
  disc.problem = std::move(problem);
  for (const auto& body : disc.problem.solids) {
    disc.placed_solids.push_back(body.mesh);
    disc.solid_spaces.push_back(build_quadratic_space(body.mesh));
  }
  disc.cutter.emplace(disc.problem.background, disc.placed_solids, options);
  disc.cut = disc.cutter->cut(disc.placed_solids);
  number_unknowns(disc);
  return disc;
}

template <int dim>
Discretisation<dim> recut(Discretisation<dim>& before, const Eigen::VectorXd& placement,
                          const CutOptions& options) {
  Discretisation<dim> disc;
  disc.interface_moves = true;
  Eigen::Index first = 0;
  for (std::size_t s = 0; s < before.problem.solids.size(); ++s) {
    // The vertices come first among the quadratic nodes.
    auto& placed = disc.placed_solids.emplace_back(before.problem.solids[s].mesh);
    for (std::size_t i = 0; i < placed.points.size(); ++i)
      placed.points[i] += placement.template segment<dim>(first + static_cast<Eigen::Index>(i) * dim);
    first += static_cast<Eigen::Index>(before.solid_spaces[s].nodes.size()) * dim;
  }
  disc.cutter = before.cutter;
  if (disc.cutter->options() != options)
    disc.cutter.emplace(before.problem.background, disc.placed_solids, options);
  disc.cut = disc.cutter->cut(disc.placed_solids); // may throw: before stays
  disc.problem = std::move(before.problem);
  disc.solid_spaces = std::move(before.solid_spaces);
  number_unknowns(disc);
  return disc;
}

template <int dim>
std::vector<Point<dim>> unknown_positions(const Discretisation<dim>& disc) {
  std::vector<Point<dim>> positions(disc.unknowns());
  for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node)
    for (int c = 0; c <= dim; ++c)
      positions[node * (dim + 1) + c] = disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]];
  for (std::size_t s = 0; s < disc.solid_spaces.size(); ++s)
    for (std::size_t node = 0; node < disc.solid_spaces[s].nodes.size(); ++node)
      for (int c = 0; c < dim; ++c)
        positions[disc.solid_unknown(static_cast<int>(s), static_cast<int>(node), c)] =
            disc.solid_spaces[s].nodes[node];
  return positions;
}

template <int dim>
Ownership distribute_unknowns(const Discretisation<dim>& disc, int ranks) {
  const auto positions = unknown_positions(disc);
  const int count = disc.unknowns();
  Ownership ownership;
  ownership.owner.assign(count, 0);
  std::vector<int> items(count);
  std::iota(items.begin(), items.end(), 0);
  bisect<dim>(items, positions, 0, ranks, ownership.owner);
  ownership.first.assign(ranks + 1, 0);
  for (const int rank : ownership.owner) ++ownership.first[rank + 1];
  std::partial_sum(ownership.first.begin(), ownership.first.end(), ownership.first.begin());
  std::vector<int> next(ownership.first.begin(), ownership.first.end() - 1);
  ownership.petsc_index.resize(count);
  for (int i = 0; i < count; ++i) ownership.petsc_index[i] = next[ownership.owner[i]]++;
  return ownership;
}

template struct Discretisation<2>;
template void constrain_rows(const Discretisation<2>&, Eigen::VectorXd&);
template Discretisation<2> discretise(FsiProblem<2>, const CutOptions&);
template Discretisation<2> recut(Discretisation<2>&, const Eigen::VectorXd&, const CutOptions&);
template std::vector<Point<2>> unknown_positions(const Discretisation<2>&);
template Ownership distribute_unknowns(const Discretisation<2>&, int);

} // namespace undula::fom
