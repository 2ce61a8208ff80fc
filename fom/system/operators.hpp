// The operators of a discretisation that never change in time, assembled once, and the convection that does.
#pragma once

#include <mpi.h>

#include <map>
#include <string>

#include "fom/assembly/nonlinear_solid.hpp"
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
  PartMoments<dim> moments;
  PartMoments<dim> widening;  ///< moments with the weight div w, w the velocity of the map; empty: identity
  std::vector<int> own_parts; ///< parts of the share
  std::vector<Eigen::Matrix<double, dim, dim + 1>> gradients; ///< barycentric, by part, moved
  std::vector<VelocityJump<dim>> velocity_jumps;   ///< of the share, where the local velocity scales them
  std::map<std::string, Eigen::VectorXd> openings; ///< outward flow functional of every opening, cm^3/s
};

/// Collective over `comm`. Phase "assemble".
template <int dim>
Operators<dim> build_operators(const Discretisation<dim>& disc, MPI_Comm comm, PhaseTimer& timer);

/// Velocity of the vertices of a fluid part, column per vertex.
template <int dim>
Eigen::Matrix<double, dim, dim + 1> part_velocity(const Discretisation<dim>& disc, int part,
                                                  const Eigen::VectorXd& x);

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
  visit_velocity_jumps<dim>(disc, operators.velocity_jumps, b, f);
}

/// Sum of `values` over all ranks, in place.
void sum_over_ranks(MPI_Comm comm, Eigen::VectorXd& values);

// ---------------------------------------------------------------------------------------------------------------

template <int dim, class F>
void visit_opening_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, F&& f) {
  const double density = disc.problem.fluid.density;
  if (disc.problem.flow != FlowModel::navier_stokes) return;
  const Measure measure = measure_of(disc.problem.space);
  const Share share{&operators.ownership.owner, operators.rank};
  for (const auto& piece : disc.cut.boundary) {
    const auto& condition = disc.problem.boundary.at(disc.problem.background.boundary_names[piece.tag]);
    if (condition.kind != BoundaryCondition<dim>::Kind::opening ||
        condition.opening == OpeningCondition::total_pressure)
      continue;
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
    const int cell = disc.cut.parts[piece.part].cell;
    const auto& facet = disc.cut.facets.facets[piece.facet];
    const Point<dim> normal = -operators.gradients[piece.part].col(facet.local[0]).normalized();
    const auto velocity = part_velocity(disc, piece.part, b);
    Eigen::Matrix<double, dim + 1, dim + 1> local = Eigen::Matrix<double, dim + 1, dim + 1>::Zero();
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = disc.cut.boundary_quadrature.points[q];
      const auto lambda = barycentric_coordinates(disc.cut.mesh, cell, x);
      double through = normal.dot(velocity * lambda);
      if (condition.opening == OpeningCondition::static_pressure) through = std::max(through, 0.0);
      local += 0.5 * density * disc.cut.boundary_quadrature.weights[q] * measure(x[0]) * through * lambda *
               lambda.transpose();
    }
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
  }
}

template <int dim, class F>
void visit_convection(const Discretisation<dim>& disc, const Operators<dim>& operators,
                      const Eigen::VectorXd& b, F&& f) {
  const double density = disc.problem.fluid.density;
  const bool convects = disc.problem.flow == FlowModel::navier_stokes, moved = !disc.map.is_identity();
  if (!convects && !moved) return;
  for (const int part : operators.own_parts) {
    const auto& nodes = disc.fluid_nodes.part_dofs[part];
    Eigen::Matrix<double, dim, dim + 1> relative = Eigen::Matrix<double, dim, dim + 1>::Zero();
    if (convects) relative = part_velocity(disc, part, b);
    if (moved) relative -= domain_velocity(disc, part);
    auto local = part_convection<dim>(density, operators.moments[part], operators.gradients[part], relative);
    if (moved) local += 0.5 * density * operators.widening[part];
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
  }
  const Measure measure = measure_of(disc.problem.space);
  const Share share{&operators.ownership.owner, operators.rank};
  if (!convects) {
    for (const auto& piece : disc.cut.interface) {
      const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
      if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
      const auto geometry = part_geometry(disc, piece.part);
      const auto velocity = domain_velocity(disc, piece.part);
      const Point<dim> area_vector = geometry.cofactor * piece.normal;
      Eigen::Matrix<double, dim + 1, dim + 1> local = Eigen::Matrix<double, dim + 1, dim + 1>::Zero();
      for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
        const auto lambda = geometry.barycentric(disc.cut.interface_quadrature.points[q]);
        const double through = -area_vector.dot(velocity * lambda);
        local += 0.5 * density * disc.cut.interface_quadrature.weights[q] *
                 measure(geometry.corners.row(0).dot(lambda)) * through * lambda * lambda.transpose();
      }
      for (int i = 0; i <= dim; ++i)
        for (int j = 0; j <= dim; ++j)
          for (int c = 0; c < dim; ++c)
            f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
    }
    return;
  }
  visit_opening_convection(disc, operators, b, f);
  if (!disc.interface_moves) return;
  for (const auto& piece : disc.cut.interface) {
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
    const auto velocity = part_velocity(disc, piece.part, b);
    Eigen::Matrix<double, dim + 1, dim + 1> local = Eigen::Matrix<double, dim + 1, dim + 1>::Zero();
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = disc.cut.interface_quadrature.points[q];
      const auto lambda = barycentric_coordinates(disc.cut.mesh, disc.cut.parts[piece.part].cell, x);
      local += 0.5 * density * disc.cut.interface_quadrature.weights[q] * measure(x[0]) *
               piece.normal.dot(velocity * lambda) * lambda * lambda.transpose();
    }
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c), local(i, j));
  }
}

} // namespace undula::fom
