// Volume forms of quadratic velocities with linear pressures. Rows are test functions.
#pragma once

#include "fom/assembly/forms.hpp"
#include "fom/space/velocity_element.hpp"

namespace undula::fom {

/// rho (u, v) into `mass`; 2 mu (eps(u), eps(v)) - (p, div v) + (q, div u) into `physical`. Of one part, with
/// the hoop terms in axisymmetric space.
template <int dim>
void add_quadratic_part(const Discretisation<dim>& disc, int part, const PartGeometry<dim>& geometry,
                        Triplets& mass, Triplets& physical);

template <int dim>
using QuadraticProducts =
    Eigen::Matrix<double, VelocityElement<dim, 2>::nodes, VelocityElement<dim, 2>::nodes>;

/// Skew convection rho/2 [((a.grad) u, v) - ((a.grad) v, u)] + rho/2 (div w u, v) of one part for the scalar
/// basis: entry (i, j) couples test node i and trial node j of every velocity component. a = b - w, `b` by
/// node of the part, w the velocity of the domain.
template <int dim>
QuadraticProducts<dim> quadratic_convection(const Discretisation<dim>& disc, int part,
                                            const PartGeometry<dim>& geometry,
                                            const typename VelocityElement<dim, 2>::Coefficients& b);

} // namespace undula::fom
