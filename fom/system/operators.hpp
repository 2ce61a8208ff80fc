// The operators of a discretisation that never change in time, assembled once, and the convection that does.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "fom/assembly/nonlinear_solid.hpp"
#include "fom/assembly/quadratic_forms.hpp"
#include "fom/assembly/velocity_jump.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// With x the unknowns (fluid velocity and pressure, solid velocity) and d the solid displacement,
///   mass x' + (physical + stabilisation + damping) x + stiffness d + f(d, x) + (convection(x) + jumps(x)) x
///     = loads,
/// f the internal forces of solids with a nonlinear law (assembly/nonlinear_solid.hpp).
/// Matrices are this rank's share in natural numbering; functionals are complete on every rank.
template <int dim>
struct Operators {
  MPI_Comm comm = MPI_COMM_SELF;
  int rank = 0;
  Ownership ownership;
  SparseMatrix mass;
  SparseMatrix physical;      ///< viscosity, pressure, divergence, consistent interface terms
  SparseMatrix stabilisation; ///< interior penalty, ghost penalty, Nitsche penalty, as far as constant
  SparseMatrix damping;       ///< Kelvin-Voigt of linear solids (damping_time * stiffness), Rayleigh of all
  SparseMatrix stiffness;     ///< of linear solids; zeros for the others
  bool has_nonlinear_solid = false;       ///< on any rank
  std::vector<SolidCell> nonlinear_cells; ///< of the share
  PartMoments<dim> moments;               ///< of linear velocities; else empty
  PartMoments<dim> widening;  ///< moments with the weight div w, w the velocity of the map; else empty
  std::vector<int> own_parts; ///< parts of the share with a weight
  std::vector<PartGeometry<dim>> geometries;       ///< by part, moved
  VelocityJumps<dim> velocity_jumps;               ///< of the share, where the local velocity scales them
  std::map<std::string, Eigen::VectorXd> openings; ///< outward flow functional of every opening, cm^3/s
  Triplets solid_mass;                             ///< the part of `mass` that no map changes
  RepeatedSum mass_sum, physical_sum, stabilisation_sum; ///< for move_operators
};

/// Collective over `comm`. Phase "assemble".
template <int dim>
Operators<dim> build_operators(const Discretisation<dim>& disc, MPI_Comm comm, PhaseTimer& timer);

/// The operators of the same cut after disc.map has changed. The openings do not move. Collective. Phase
/// "assemble".
template <int dim>
void move_operators(const Discretisation<dim>& disc, Operators<dim>& operators, PhaseTimer& timer);

/// Whether `visit_convection` has entries: fluid that convects, or a domain that moves by a map.
template <int dim>
bool has_convection(const Discretisation<dim>& disc) {
  return disc.problem.flow == FlowModel::navier_stokes || !disc.map.is_identity();
}

/// Visits every entry (row, column, value) of the convection matrix for the convecting field `b`: the skew
/// volume term of the share (on a domain that moves by a map with velocity w, of b - w, or in Stokes flow of
/// -w alone, and rho/2 (div w u, v), so that the energy of the moving domain is kept), the momentum carried
/// through openings that ask for it (see OpeningCondition) and, where the interface moves through the
/// background, the momentum it takes along: half of (rho b.n u, v), so that with the time derivative the
/// energy of the moving domain is kept. The sequence of (row, column) does not depend on `b`.
template <int dim, class F>
void visit_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                      const Eigen::VectorXd& b, F&& f);

/// The part of it that carries kinetic energy through openings.
template <int dim, class F>
void visit_opening_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, F&& f);

/// Visits every entry of what depends on the convecting field: convection and the penalty on velocity jumps
/// that the local velocity scales.
template <int dim, class F>
void visit_flow_dependent(const Discretisation<dim>& disc, const Operators<dim>& operators,
                          const Eigen::VectorXd& b, F&& f) {
  visit_convection(disc, operators, b, f);
  visit_velocity_jumps(disc, operators.velocity_jumps, b, f);
}

/// Sum of `values` over all ranks, in place.
void sum_over_ranks(MPI_Comm comm, Eigen::VectorXd& values);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// Visits rho/2 (through u, v) over one piece of a boundary or skin, for every velocity component. place(q):
/// barycentric coordinates of a quadrature point and its weight with the measure; through(lambda, shape): the
/// speed across the piece there.
template <int dim, int order, class Place, class Through, class F>
void visit_carried(const Discretisation<dim>& disc, int part, int first, int last, Place&& place,
                   Through&& through, F&& f) {
  using Element = VelocityElement<dim, order>;
  const auto nodes = Element::nodes_of(disc, part);
  Eigen::Matrix<double, Element::nodes, Element::nodes> local =
      Eigen::Matrix<double, Element::nodes, Element::nodes>::Zero();
  for (int q = first; q < last; ++q) {
    const auto [lambda, weight] = place(q);
    const auto shape = Element::values(lambda);
    local += 0.5 * disc.problem.fluid.density * weight * through(lambda, shape) * shape * shape.transpose();
  }
  for (int i = 0; i < Element::nodes; ++i)
    for (int j = 0; j < Element::nodes; ++j)
      for (int c = 0; c < dim; ++c)
        f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
}

template <int dim, int order, class F>
void visit_part_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                           const Eigen::VectorXd& b, F&& f) {
  using Element = VelocityElement<dim, order>;
  const bool convects = disc.problem.flow == FlowModel::navier_stokes, moved = !disc.map.is_identity();
  const double density = disc.problem.fluid.density;
  for (const int part : operators.own_parts) {
    const auto nodes = Element::nodes_of(disc, part);
    typename Element::Coefficients velocity = Element::Coefficients::Zero();
    if (convects) velocity = Element::coefficients(disc, part, b);
    Eigen::Matrix<double, Element::nodes, Element::nodes> local;
    if constexpr (order == 1) {
      if (moved) velocity -= domain_velocity(disc, part);
      local = part_convection<dim>(density, operators.moments[part], operators.geometries[part].gradients,
                                   velocity);
      if (moved) local += 0.5 * density * operators.widening[part];
    } else {
      local = quadratic_convection<dim>(disc, part, operators.geometries[part], velocity);
    }
    for (int i = 0; i < Element::nodes; ++i)
      for (int j = 0; j < Element::nodes; ++j)
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
  }
}

/// What moves along with the skin of a domain that moves by a map.
template <int dim, int order, class F>
void visit_moved_skin(const Discretisation<dim>& disc, const Operators<dim>& operators, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  const Share share{&operators.ownership.owner, operators.rank};
  for (const auto& piece : disc.cut.interface) {
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[piece.part][0], 0))) continue;
    const auto& geometry = operators.geometries[piece.part];
    const auto velocity = domain_velocity(disc, piece.part);
    const Point<dim> area_vector = geometry.cofactor * piece.normal;
    const auto place = [&](int q) {
      const auto lambda = geometry.barycentric(disc.cut.interface_quadrature.points[q]);
      return std::pair(lambda, geometry.weight * disc.cut.interface_quadrature.weights[q] *
                                   measure(geometry.corners.row(0).dot(lambda)));
    };
    visit_carried<dim, order>(
        disc, piece.part, piece.quadrature_begin, piece.quadrature_end, place,
        [&](const auto& lambda, const auto&) { return -area_vector.dot(velocity * lambda); }, f);
  }
}

template <int dim, int order, class F>
void visit_openings(const Discretisation<dim>& disc, const Operators<dim>& operators,
                    const Eigen::VectorXd& b, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  const Share share{&operators.ownership.owner, operators.rank};
  for (const auto& piece : disc.cut.boundary) {
    const auto& condition = disc.problem.boundary.at(disc.problem.background.boundary_names[piece.tag]);
    if (condition.kind != BoundaryCondition<dim>::Kind::opening ||
        condition.opening == OpeningCondition::total_pressure)
      continue;
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[piece.part][0], 0))) continue;
    const int cell = disc.cut.parts[piece.part].cell;
    const auto& facet = disc.cut.facets.facets[piece.facet];
    const Point<dim> normal = -operators.geometries[piece.part].gradients.col(facet.local[0]).normalized();
    const auto velocity = VelocityElement<dim, order>::coefficients(disc, piece.part, b);
    const auto place = [&](int q) {
      const auto& x = disc.cut.boundary_quadrature.points[q];
      return std::pair(barycentric_coordinates(disc.cut.mesh, cell, x),
                       disc.cut.boundary_quadrature.weights[q] * measure(x[0]));
    };
    visit_carried<dim, order>(
        disc, piece.part, piece.quadrature_begin, piece.quadrature_end, place,
        [&](const auto&, const auto& shape) {
          const double through = normal.dot(velocity * shape);
          return condition.opening == OpeningCondition::static_pressure ? std::max(through, 0.0) : through;
        },
        f);
  }
}

/// Momentum that an interface takes along which moves through the background.
template <int dim, int order, class F>
void visit_recut_skin(const Discretisation<dim>& disc, const Operators<dim>& operators,
                      const Eigen::VectorXd& b, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  const Share share{&operators.ownership.owner, operators.rank};
  for (const auto& piece : disc.cut.interface) {
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[piece.part][0], 0))) continue;
    const auto velocity = VelocityElement<dim, order>::coefficients(disc, piece.part, b);
    const auto place = [&](int q) {
      const auto& x = disc.cut.interface_quadrature.points[q];
      return std::pair(barycentric_coordinates(disc.cut.mesh, disc.cut.parts[piece.part].cell, x),
                       disc.cut.interface_quadrature.weights[q] * measure(x[0]));
    };
    visit_carried<dim, order>(
        disc, piece.part, piece.quadrature_begin, piece.quadrature_end, place,
        [&](const auto&, const auto& shape) { return piece.normal.dot(velocity * shape); }, f);
  }
}

} // namespace detail

template <int dim, class F>
void visit_opening_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, F&& f) {
  if (disc.problem.flow != FlowModel::navier_stokes) return;
  with_order(disc, [&](auto order) { detail::visit_openings<dim, order>(disc, operators, b, f); });
}

template <int dim, class F>
void visit_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                      const Eigen::VectorXd& b, F&& f) {
  if (!has_convection(disc)) return;
  const bool convects = disc.problem.flow == FlowModel::navier_stokes;
  with_order(disc, [&](auto order) {
    detail::visit_part_convection<dim, order>(disc, operators, b, f);
    if (!convects)
      detail::visit_moved_skin<dim, order>(disc, operators, f);
    else
      detail::visit_openings<dim, order>(disc, operators, b, f);
    if (convects && disc.interface_moves) detail::visit_recut_skin<dim, order>(disc, operators, b, f);
  });
}

} // namespace undula::fom
