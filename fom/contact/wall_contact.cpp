#include "fom/contact/wall_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace undula {

namespace {

/// Part of the film below which the barrier goes on as its tangent.
constexpr double tangent_below = 0.05;

} // namespace

FilmPressure film_pressure(const ContactSettings& settings, double gap) {
  if (gap >= settings.film) return {};
  const double at = std::max(gap, tangent_below * settings.film);
  const double slope = -settings.stiffness * settings.film / (at * at);
  return {settings.stiffness * (settings.film / at - 1) + slope * (gap - at), slope};
}

template <int dim>
WallContact<dim> prepare_contact(const Discretisation<dim>& disc, const ContactSettings& settings) {
  WallContact<dim> contact;
  contact.settings = settings;
  const Measure measure = measure_of(disc.problem.space);
  std::map<int, typename WallContact<dim>::SkinNode> skin; // by unknown
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& mesh = disc.problem.solids[s].mesh;
    const auto& space = disc.solid_spaces[s];
    const auto facets = build_facet_table(mesh);
    for (const auto& facet : facets.facets) {
      if (facet.cells[1] >= 0) continue;
      const auto& g = barycentric_gradients(mesh, facet.cells[0]);
      const double area = dim * cell_measure(mesh, facet.cells[0]) * g.col(facet.local[0]).norm();
      // Simpson's rule on the quadratic nodes of an edge: vertices 1/6, mid-point 4/6.
      static_assert(dim == 2);
      const auto& cell = mesh.cells[facet.cells[0]];
      const auto local_of = [&](int point) {
        return static_cast<int>(std::find(cell.begin(), cell.end(), point) - cell.begin());
      };
      const int a = local_of(facet.points[0]), b = local_of(facet.points[1]);
      const int middle = dim + std::min(a, b) + std::max(a, b); // edges (0,1), (0,2), (1,2)
      const auto& nodes = space.cell_nodes[facet.cells[0]];
      for (const auto& [local, weight] : {std::pair{a, 1.0 / 6}, {b, 1.0 / 6}, {middle, 4.0 / 6}}) {
        const int unknown = disc.solid_unknown(static_cast<int>(s), nodes[local], 0);
        if (disc.is_constrained[unknown]) continue;
        auto& node = skin[unknown - disc.fluid_unknowns()];
        node.unknown = unknown - disc.fluid_unknowns();
        node.at_rest = space.nodes[nodes[local]];
        node.area += weight * area * measure(node.at_rest[0]);
      }
    }
  }
  const auto facets = build_facet_table(disc.problem.background);
  for (const auto& facet : facets.facets) {
    if (facet.cells[1] >= 0) continue;
    const auto& condition =
        disc.problem.boundary.at(disc.problem.background.boundary_names[facet.boundary_tag]);
    if (condition.kind != BoundaryCondition<dim>::Kind::velocity) continue;
    auto& wall = contact.walls.emplace_back();
    for (int i = 0; i < dim; ++i) wall.points[i] = disc.problem.background.points[facet.points[i]];
    wall.normal =
        barycentric_gradients(disc.problem.background, facet.cells[0]).col(facet.local[0]).normalized();
  }
  for (const auto& [unknown, node] : skin)
    if (gap_to_walls<dim>(contact, node.at_rest).distance > settings.film) contact.skin.push_back(node);
  return contact;
}

template <int dim>
Gap<dim> gap_to_walls(const WallContact<dim>& contact, const Point<dim>& x) {
  Gap<dim> gap;
  double nearest = std::numeric_limits<double>::infinity(), inward = -1;
  for (const auto& wall : contact.walls) {
    const Point<dim> along = wall.points[1] - wall.points[0];
    const double s = std::clamp((x - wall.points[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Point<dim> away = x - wall.points[0] - s * along;
    const double distance = away.norm(), side = away.dot(wall.normal);
    // At a corner, two walls are equally near; the one that faces x more decides which side x is on.
    if (distance > nearest * (1 + 1e-12) || (distance >= nearest * (1 - 1e-12) && std::abs(side) <= inward))
      continue;
    nearest = distance;
    inward = std::abs(side);
    const bool inside = side >= 0;
    gap.distance = inside ? distance : -distance;
    gap.direction = distance > 0 ? Point<dim>((inside ? 1 : -1) * away / distance) : wall.normal;
  }
  if (contact.walls.empty()) gap.distance = nearest;
  return gap;
}

template <int dim>
double smallest_gap(const WallContact<dim>& contact, const Eigen::VectorXd& placement) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& node : contact.skin)
    smallest = std::min(
        smallest,
        gap_to_walls<dim>(contact, node.at_rest + placement.template segment<dim>(node.unknown)).distance);
  return smallest;
}

template <int dim>
ContactForce contact_force(const WallContact<dim>& contact, const Discretisation<dim>& disc,
                           const Eigen::VectorXd& placement) {
  ContactForce force;
  force.load = Eigen::VectorXd::Zero(disc.unknowns());
  Triplets entries;
  for (const auto& node : contact.skin) {
    const Point<dim> displacement = placement.template segment<dim>(node.unknown);
    const auto gap = gap_to_walls<dim>(contact, node.at_rest + displacement);
    if (gap.distance >= contact.settings.film) continue;
    ++force.nodes;
    const auto film = film_pressure(contact.settings, gap.distance);
    const int unknown = disc.fluid_unknowns() + node.unknown;
    const double stiffness = -node.area * film.slope;
    force.load.template segment<dim>(unknown) +=
        (node.area * film.pressure + stiffness * gap.direction.dot(displacement)) * gap.direction;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        entries.emplace_back(unknown + i, unknown + j, stiffness * gap.direction[i] * gap.direction[j]);
  }
  force.stiffness = compress(disc.unknowns(), entries);
  return force;
}

template WallContact<2> prepare_contact(const Discretisation<2>&, const ContactSettings&);
template Gap<2> gap_to_walls(const WallContact<2>&, const Point<2>&);
template double smallest_gap(const WallContact<2>&, const Eigen::VectorXd&);
template ContactForce contact_force(const WallContact<2>&, const Discretisation<2>&, const Eigen::VectorXd&);

} // namespace undula
