#include "fom/contact/wall_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/triangles.hpp"

namespace undula::fom {

namespace {

/// Part of the film below which the barrier goes on as its tangent.
constexpr double tangent_below = 0.01;

/// Local vertices of the facet of a cell opposite vertex `opposite`, the cell on their left or, in space,
/// behind them.
template <int dim>
std::array<int, dim> facet_vertices(int opposite) {
  if constexpr (dim == 2) {
    return {(opposite + 1) % 3, (opposite + 2) % 3};
  } else {
    constexpr std::array<std::array<int, 3>, 4> vertices{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    return vertices[static_cast<std::size_t>(opposite)];
  }
}

/// Edges of a facet.
template <int dim>
constexpr int middles = dim == 2 ? 1 : 3;

/// The node of a quadratic cell half-way between two of its vertices.
template <int dim>
int middle_node(int a, int b) {
  constexpr auto edges = local_edges<dim>();
  const auto found = std::find(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)});
  return dim + 1 + static_cast<int>(found - edges.begin());
}

/// From the nearest point of a wall to x.
Point<2> away_from(const BoundaryWall<2>& wall, const Point<2>& x) {
  const Point<2> along = wall.points[1] - wall.points[0];
  const double s = nearest_on_segment<2>(wall.points[0], wall.points[1], x);
  return x - wall.points[0] - s * along;
}
Point<3> away_from(const BoundaryWall<3>& wall, const Point<3>& x) {
  return x - nearest_on_triangle(wall.points, x);
}

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
  contact.axisymmetric = disc.problem.space == Space::axisymmetric;
  contact.walls = boundary_walls(disc.problem);
  std::map<int, int> index_of; // by unknown; -1: takes no part
  const auto skin_node = [&](int solid, int node) {
    const int unknown = disc.solid_unknown(solid, node, 0);
    const auto [found, is_new] = index_of.try_emplace(unknown, -1);
    const auto& at_rest = disc.solid_spaces[solid].nodes[node];
    if (is_new && !disc.is_constrained[unknown] &&
        gap_to_walls<dim>(contact, at_rest).distance > settings.film) {
      found->second = static_cast<int>(contact.skin.size());
      contact.skin.push_back({unknown - disc.fluid_unknowns(), at_rest});
    }
    return found->second;
  };
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const int solid = static_cast<int>(s);
    const auto& mesh = disc.problem.solids[s].mesh;
    for (const auto& facet : build_facet_table(mesh).facets) {
      if (facet.cells[1] >= 0) continue;
      const auto vertices = facet_vertices<dim>(facet.local[0]);
      const auto& nodes = disc.solid_spaces[s].cell_nodes[facet.cells[0]];
      auto& edge = contact.edges.emplace_back();
      for (int k = 0; k < dim; ++k) {
        edge.nodes[k] = skin_node(solid, nodes[vertices[k]]);
        edge.unknowns[k] = disc.solid_unknown(solid, nodes[vertices[k]], 0) - disc.fluid_unknowns();
        edge.at_rest[k] = disc.solid_spaces[s].nodes[nodes[vertices[k]]];
      }
      for (int k = 0; k < middles<dim>; ++k)
        edge.nodes[dim + k] = skin_node(solid, nodes[middle_node<dim>(vertices[k], vertices[(k + 1) % dim])]);
    }
  }
  return contact;
}

template <int dim>
Gap<dim> gap_to_walls(const WallContact<dim>& contact, const Point<dim>& x) {
  Gap<dim> gap;
  double nearest = std::numeric_limits<double>::infinity(), inward = -1;
  for (const auto& wall : contact.walls) {
    const Point<dim> away = away_from(wall, x);
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
double film_difference(const WallContact<dim>& contact, const Eigen::VectorXd& first,
                       const Eigen::VectorXd& second) {
  double largest = 0;
  for (const auto& node : contact.skin) {
    const auto gap = [&](const Eigen::VectorXd& placement) {
      return gap_to_walls<dim>(contact, node.at_rest + placement.template segment<dim>(node.unknown))
          .distance;
    };
    const double a = gap(first), b = gap(second), smaller = std::min(a, b);
    if (smaller >= contact.settings.film) continue;
    if (smaller <= 0) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(a - b) / smaller);
  }
  return largest;
}

namespace {

/// Area vectors of the skin's nodes, out of the solids where they are placed: Simpson's rule on every edge,
/// on triangles the rule of the mid-points, as exact.
template <int dim>
std::vector<Point<dim>> node_areas(const WallContact<dim>& contact, const Eigen::VectorXd& placement) {
  const Measure measure{contact.axisymmetric};
  std::vector<Point<dim>> areas(contact.skin.size(), Point<dim>::Zero());
  for (const auto& edge : contact.edges) {
    std::array<Point<dim>, dim> x;
    for (int k = 0; k < dim; ++k) x[k] = edge.at_rest[k] + placement.template segment<dim>(edge.unknowns[k]);
    const auto add = [&](int node, const Point<dim>& area) {
      if (node >= 0) areas[node] += area;
    };
    if constexpr (dim == 2) {
      const auto &a = x[0], &b = x[1];
      const Point<dim> outward(b[1] - a[1], a[0] - b[0]);
      add(edge.nodes[0], measure(a[0]) / 6 * outward);
      add(edge.nodes[1], measure(b[0]) / 6 * outward);
      add(edge.nodes[2], 4 * measure(0.5 * (a[0] + b[0])) / 6 * outward);
    } else {
      const Point<dim> outward = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
      for (int k = dim; k < 2 * dim; ++k) add(edge.nodes[k], outward / 3);
    }
  }
  return areas;
}

} // namespace

template <int dim>
ContactForce contact_force(const WallContact<dim>& contact, const Discretisation<dim>& disc,
                           const Eigen::VectorXd& placement) {
  ContactForce force;
  force.load = Eigen::VectorXd::Zero(disc.unknowns());
  Triplets entries;
  const auto areas = node_areas(contact, placement);
  for (std::size_t k = 0; k < contact.skin.size(); ++k) {
    const auto& node = contact.skin[k];
    const Point<dim> displacement = placement.template segment<dim>(node.unknown);
    const auto gap = gap_to_walls<dim>(contact, node.at_rest + displacement);
    const double area = -areas[k].dot(gap.direction);
    if (gap.distance >= contact.settings.film || area <= 0) continue;
    ++force.nodes;
    const auto film = film_pressure(contact.settings, gap.distance);
    const int unknown = disc.fluid_unknowns() + node.unknown;
    const double stiffness = -area * film.slope;
    force.load.template segment<dim>(unknown) +=
        (area * film.pressure + stiffness * gap.direction.dot(displacement)) * gap.direction;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        entries.emplace_back(unknown + i, unknown + j, stiffness * gap.direction[i] * gap.direction[j]);
  }
  force.stiffness = compress(disc.unknowns(), entries);
  return force;
}

template <int dim>
void keep_off_walls(const WallContact<dim>& contact, const Eigen::VectorXd& now, Eigen::VectorXd& placement) {
  for (const auto& node : contact.skin) {
    auto placed = placement.template segment<dim>(node.unknown);
    const Point<dim> here = now.template segment<dim>(node.unknown);
    const double gap = gap_to_walls<dim>(contact, node.at_rest + placed).distance;
    if (gap >= 0.5 * contact.settings.film) continue;
    const double left = gap_to_walls<dim>(contact, node.at_rest + here).distance,
                 least = 0.5 * std::min(left, contact.settings.film);
    if (gap >= least || gap >= left) continue;
    placed = here + (left - least) / (left - gap) * (placed - here);
  }
}

template <int dim>
ContactBalance contact_balance(const WallContact<dim>& contact, const Eigen::VectorXd& linearised,
                               const Eigen::VectorXd& displacement) {
  ContactBalance balance;
  balance.smallest_gap = std::numeric_limits<double>::infinity();
  balance.linearised = displacement;
  const auto areas = node_areas(contact, displacement);
  double exact = 0, difference = 0;
  for (std::size_t k = 0; k < contact.skin.size(); ++k) {
    const auto& node = contact.skin[k];
    const Point<dim> before = linearised.template segment<dim>(node.unknown),
                     after = displacement.template segment<dim>(node.unknown);
    const auto old_gap = gap_to_walls<dim>(contact, node.at_rest + before),
               new_gap = gap_to_walls<dim>(contact, node.at_rest + after);
    balance.smallest_gap = std::min(balance.smallest_gap, new_gap.distance);
    const auto at = film_pressure(contact.settings, old_gap.distance);
    const double expected = at.pressure + at.slope * old_gap.direction.dot(after - before),
                 film = film_pressure(contact.settings, new_gap.distance).pressure,
                 area = std::abs(areas[k].dot(new_gap.direction));
    exact += area * film;
    difference += area * std::abs(film - expected);
    const double least = 0.3 * std::min(old_gap.distance, contact.settings.film);
    if (new_gap.distance < least)
      balance.linearised.template segment<dim>(node.unknown) =
          before + (old_gap.distance - least) / (old_gap.distance - new_gap.distance) * (after - before);
  }
  balance.error = difference > 0 ? difference / std::max(exact, std::numeric_limits<double>::min()) : 0;
  return balance;
}

template double film_difference(const WallContact<2>&, const Eigen::VectorXd&, const Eigen::VectorXd&);
template void keep_off_walls(const WallContact<2>&, const Eigen::VectorXd&, Eigen::VectorXd&);
template ContactBalance contact_balance(const WallContact<2>&, const Eigen::VectorXd&,
                                        const Eigen::VectorXd&);
template WallContact<2> prepare_contact(const Discretisation<2>&, const ContactSettings&);
template Gap<2> gap_to_walls(const WallContact<2>&, const Point<2>&);
template double smallest_gap(const WallContact<2>&, const Eigen::VectorXd&);
template ContactForce contact_force(const WallContact<2>&, const Discretisation<2>&, const Eigen::VectorXd&);

template double film_difference(const WallContact<3>&, const Eigen::VectorXd&, const Eigen::VectorXd&);
template void keep_off_walls(const WallContact<3>&, const Eigen::VectorXd&, Eigen::VectorXd&);
template ContactBalance contact_balance(const WallContact<3>&, const Eigen::VectorXd&,
                                        const Eigen::VectorXd&);
template WallContact<3> prepare_contact(const Discretisation<3>&, const ContactSettings&);
template Gap<3> gap_to_walls(const WallContact<3>&, const Point<3>&);
template double smallest_gap(const WallContact<3>&, const Eigen::VectorXd&);
template ContactForce contact_force(const WallContact<3>&, const Discretisation<3>&, const Eigen::VectorXd&);

} // namespace undula::fom
