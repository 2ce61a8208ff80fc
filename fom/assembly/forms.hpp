// The weak forms, integrated over this rank's share of the cut mesh. Rows are test functions.
// All integrals carry the measure (2 pi r in axisymmetric space).
#pragma once

#include "fom/assembly/sparse.hpp"
#include "fom/space/discretisation.hpp"

namespace undula {

/// Which parts and cells a rank integrates: those whose first node it owns.
struct Share {
  const std::vector<int>* owner = nullptr; ///< by unknown
  int rank = 0;
  bool has(int unknown) const { return (*owner)[unknown] == rank; }
};

/// int lambda_k lambda_i dV over every fluid part, (dim+1) x (dim+1) per part, zero outside the share.
/// cm^dim. Mass and convection of P1 fields on affine simplices need nothing else.
template <int dim>
using PartMoments = std::vector<Eigen::Matrix<double, dim + 1, dim + 1>>;
template <int dim>
PartMoments<dim> part_moments(const Discretisation<dim>& disc, const Share& share);

/// rho (u, v).
template <int dim>
void add_fluid_mass(const Discretisation<dim>& disc, const PartMoments<dim>& moments, Triplets& out);

/// 2 mu (eps(u), eps(v)) - (p, div v) + (q, div u), with the hoop terms in axisymmetric space.
template <int dim>
void add_fluid_viscosity_and_pressure(const Discretisation<dim>& disc, const Share& share, Triplets& out);

/// Continuous interior penalty and ghost penalty (Burman & Fernandez 2006/2014; Massing, Schott & Wall 2018)
/// with weights that do not depend on the solution.
template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share, Triplets& out);

/// Nitsche coupling with the fluid-sided stress, w the solid's test function, v_s its velocity:
/// -(sigma(u,p) n, v - w) - (2 mu eps(v) n, u - v_s) - (q n, u - v_s) into `consistent`, and
/// + (gamma_v mu / h (u - v_s), v - w) + (gamma_n phi / h (u - v_s).n, (v - w).n) into `penalty`.
template <int dim>
void add_interface(const Discretisation<dim>& disc, const Share& share, Triplets& consistent,
                   Triplets& penalty);

template <int dim>
using SolidFactor = std::function<double(const SolidBody<dim>&)>;

/// rho_s (v, w); every solid times factor(solid), solids with factor 0 left out.
template <int dim>
void add_solid_mass(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                    Triplets& out);

/// (C eps(d), eps(w)), isotropic linear elasticity; every solid times factor(solid).
template <int dim>
void add_solid_stiffness(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                         Triplets& out);

/// Skew convection rho/2 [((b.grad) u, v) - ((b.grad) v, u)] of one part for the scalar basis: entry (i, j)
/// couples test vertex i and trial vertex j of every velocity component. `b` holds the vertices' convecting
/// velocity.
template <int dim>
Eigen::Matrix<double, dim + 1, dim + 1> part_convection(
    double density, const Eigen::Matrix<double, dim + 1, dim + 1>& moments,
    const Eigen::Matrix<double, dim, dim + 1>& gradients, const Eigen::Matrix<double, dim, dim + 1>& b);

/// Load vector of unit pressure on the parts of the boundary named `name`: entry = int phi_i n_c dA. Applied
/// to a velocity it is the flow out of that opening, cm^3/s.
template <int dim>
Eigen::VectorXd opening_functional(const Discretisation<dim>& disc, const Share& share,
                                   const std::string& name);

/// Body forces on fluid and solids at time t.
template <int dim>
Eigen::VectorXd body_force_load(const Discretisation<dim>& disc, const Share& share, double t);

/// phi = mu + rho (U h + h^2 / tau), see StabilisationWeights. g/(cm s).
double phi_weight(const StabilisationWeights& weights, const FluidProperties& fluid, double h);

} // namespace undula
