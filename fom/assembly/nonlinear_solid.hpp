// Solids under a nonlinear law: internal forces, their energy and their derivatives, cell by cell.
// Total Lagrangian: all integrals over the solid at rest. Hoop stretch in axisymmetric space: 1 + u_r / r.
#pragma once

#include <vector>

#include "fom/assembly/forms.hpp"
#include "fom/materials/solid_laws.hpp"

namespace undula::fom {

inline bool is_nonlinear(SolidModel model) {
  return model == SolidModel::saint_venant_kirchhoff || model == SolidModel::neo_hookean;
}

/// Whether any solid has a nonlinear law. The same on every rank.
template <int dim>
bool has_nonlinear_solid(const Discretisation<dim>& disc);

/// The cells of the share that belong to solids with a nonlinear law.
template <int dim>
std::vector<SolidCell> nonlinear_cells(const Discretisation<dim>& disc, const Share& share);

/// Places of a cell's velocities among the unknowns: node after node, component after component.
template <int dim>
std::array<int, dim * QuadraticSpace<dim>::nodes_per_cell> cell_unknowns(const Discretisation<dim>& disc,
                                                                         const SolidCell& cell);

/// Answer of one cell to displacement d (cm) and velocity v (cm/s) of its nodes. Forces are the left-hand
/// side of the balance: + internal force. dyn, erg (per cm of depth in plane space).
template <int dim>
struct CellResponse {
  static constexpr int size = dim * QuadraticSpace<dim>::nodes_per_cell;
  using Values = Eigen::Matrix<double, size, 1>;
  using Derivatives = Eigen::Matrix<double, size, size>;
  double energy = 0;
  double smallest_volume_ratio = 0; ///< of J over the points of quadrature
  Values elastic;                   ///< d energy / d d
  Values viscous;         ///< Kelvin-Voigt: stress damping_time * C : dE/dt, C the linear law's; objective
  Derivatives by_d, by_v; ///< of elastic + viscous; set only if asked for
};
template <int dim>
CellResponse<dim> cell_response(const Discretisation<dim>& disc, const SolidCell& cell,
                                const typename CellResponse<dim>::Values& d,
                                const typename CellResponse<dim>::Values& v, bool derive,
                                const typename CellResponse<dim>::Values* before = nullptr);

/// Answer of all cells given, a rank's share.
template <int dim>
struct SolidResponse {
  double energy = 0;                ///< erg
  double smallest_volume_ratio = 0; ///< infinite without cells
  Eigen::VectorXd elastic, viscous; ///< dyn, by unknown
  std::vector<typename CellResponse<dim>::Derivatives>
      tangents; ///< by cell: rate_of_d * by_d + rate_of_v * by_v
};

/// How displacement and velocity follow the unknowns: d = rate_of_d x + ..., v = rate_of_v x.
struct SolidRates {
  double d = 0; ///< s in a time step, 1 where the unknowns are displacements
  double v = 0; ///< 1 in a time step, 0 at rest
};

/// `d` and `v` in natural order. Tangents only with `derive`; `before`: null for exact derivatives, else the
/// displacements of Newton's iterate before, see material_response.
template <int dim>
SolidResponse<dim> solid_response(const Discretisation<dim>& disc, const std::vector<SolidCell>& cells,
                                  const Eigen::VectorXd& d, const Eigen::VectorXd& v, const SolidRates& rates,
                                  bool derive, const Eigen::VectorXd* before = nullptr);

/// Adds tangent * x, cell by cell, to `sum`; with `absolute`, |tangent| |x|.
template <int dim>
void add_tangent_product(const Discretisation<dim>& disc, const std::vector<SolidCell>& cells,
                         const SolidResponse<dim>& response, const Eigen::VectorXd& x, bool absolute,
                         Eigen::VectorXd& sum);

} // namespace undula::fom
