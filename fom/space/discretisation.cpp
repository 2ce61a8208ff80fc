#include "fom/space/discretisation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fom/space/facet_axis.hpp"
#include "fom/space/velocity_element.hpp"
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
      const int axis = normal_axis(disc.cut, piece.facet);
      for (const int node : facet_velocity_nodes(disc, piece.part, piece.facet)) {
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
  for (int node = 0; node < disc.velocity_nodes(); ++node)
    for (int c = 0; c < dim; ++c) {
      const int unknown = disc.velocity_unknown(node, c);
      if (!fixed[unknown]) continue;
      disc.constrained.push_back({unknown, c, disc.velocity_position(node), source[unknown]});
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

template <int dim>
void require_order(const FsiProblem<dim>& problem) {
  if (problem.velocity_order != 1 && problem.velocity_order != 2)
    throw InputError("the fluid's velocity has no such degree", std::to_string(problem.velocity_order),
                     "1 or 2", "FsiProblem::velocity_order");
}

/// Quadrature of the cuts for quadratic velocities: three of them times r inside, and on openings, where they
/// carry themselves out.
CutOptions good_enough(CutOptions options, int velocity_order) {
  if (velocity_order == 1) return options;
  options.volume_degree = std::max(options.volume_degree, 6);
  options.interface_degree = std::max(options.interface_degree, 6);
  options.boundary_degree = std::max(options.boundary_degree, 7);
  return options;
}

/// Numbering and constraints for the cut, problem and solids' spaces in `disc`.
template <int dim>
void number_unknowns(Discretisation<dim>& disc) {
  disc.fluid_nodes = build_dof_sets(disc.cut);
  disc.fluid_edges = {};
  if (disc.problem.velocity_order == 2) disc.fluid_edges = build_edge_sets(disc.cut);
  disc.solid_offset.assign(1, disc.velocity_nodes() * dim + disc.vertex_nodes());
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
  require_order(disc.problem);
  for (const auto& body : disc.problem.solids) {
    disc.placed_solids.push_back(body.mesh);
    disc.solid_spaces.push_back(build_quadratic_space(body.mesh));
  }
  disc.cutter.emplace(disc.problem.background, disc.placed_solids,
                      good_enough(options, disc.problem.velocity_order));
  disc.cut = disc.cutter->cut(disc.placed_solids);
  number_unknowns(disc);
  return disc;
}

template <int dim>
Discretisation<dim> recut(Discretisation<dim>& before, const Eigen::VectorXd& placement,
                          const CutOptions& options) {
  if (before.problem.velocity_order != 1)
    throw InputError("a cut that moves carries linear velocities only",
                     "velocity_order = " + std::to_string(before.problem.velocity_order),
                     "velocity_order = 1", "FsiProblem::velocity_order");
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
  for (int node = 0; node < disc.velocity_nodes(); ++node) {
    for (int c = 0; c < dim; ++c) positions[disc.velocity_unknown(node, c)] = disc.velocity_position(node);
    if (node < disc.vertex_nodes()) positions[disc.pressure_unknown(node)] = disc.velocity_position(node);
  }
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

template struct Discretisation<3>;
template void constrain_rows(const Discretisation<3>&, Eigen::VectorXd&);
template Discretisation<3> discretise(FsiProblem<3>, const CutOptions&);
template Discretisation<3> recut(Discretisation<3>&, const Eigen::VectorXd&, const CutOptions&);
template std::vector<Point<3>> unknown_positions(const Discretisation<3>&);
template Ownership distribute_unknowns(const Discretisation<3>&, int);

} // namespace undula::fom
