// The weak forms, integrated over this rank's share of the cut mesh. Rows are test functions.
// All integrals carry the measure (2 pi r in axisymmetric space).
#pragma once

#include "fom/assembly/part_geometry.hpp"
#include "fom/assembly/sparse.hpp"

namespace undula::fom {

/// Which parts and cells a rank integrates: those whose first node it owns.
struct Share {
  const std::vector<int>* owner = nullptr; ///< by unknown
  int rank = 0;
  bool has(int unknown) const { return (*owner)[unknown] == rank; }
};

/// Integrals over one fluid part, moved by the map, from which all its volume terms follow: those of products
/// lambda_k lambda_i with the weights 1, 1/r and 1/r^2 (axisymmetric space only), and rate of widening
/// div w of the domain. cm^dim, cm^(dim-1), cm^(dim-2), cm^dim/s.
template <int dim>
struct PartIntegrals {
  using Products = Eigen::Matrix<double, dim + 1, dim + 1>;
  Products moments = Products::Zero();
  Products over_radius = Products::Zero();
  Products over_radius_squared = Products::Zero();
  Products widening = Products::Zero();
};
template <int dim>
PartIntegrals<dim> integrate_part(const Discretisation<dim>& disc, int part,
                                  const PartGeometry<dim>& geometry);

/// By part; zero outside the share.
template <int dim>
using PartMoments = std::vector<Eigen::Matrix<double, dim + 1, dim + 1>>;

/// rho (u, v) of one part.
template <int dim>
void add_fluid_mass(const Discretisation<dim>& disc, int part, const PartIntegrals<dim>& integrals,
                    Triplets& out);

/// 2 mu (eps(u), eps(v)) - (p, div v) + (q, div u) of one part, with the hoop terms in axisymmetric space.
template <int dim>
void add_fluid_viscosity_and_pressure(const Discretisation<dim>& disc, int part,
                                      const PartGeometry<dim>& geometry, const PartIntegrals<dim>& integrals,
                                      Triplets& out);

/// Continuous interior penalty and ghost penalty (Burman & Fernandez 2006/2014; Massing, Schott & Wall 2018)
/// with weights that do not depend on the solution, on the moved elements. `geometries` of all parts.
template <int dim>
void add_fluid_stabilisation(const Discretisation<dim>& disc, const Share& share,
                             std::span<const PartGeometry<dim>> geometries, Triplets& out);

/// Nitsche coupling with the fluid-sided stress, w the solid's test function, v_s its velocity:
/// -(sigma(u,p) n, v - w) - (2 mu eps(v) n, u - v_s) - (q n, u - v_s) into `consistent`, and
/// + (gamma_v mu / h (u - v_s), v - w) + (gamma_n phi / h (u - v_s).n, (v - w).n) into `penalty`.
/// With a slip length L the tangential part is that of Nitsche's method for Robin conditions (Juntunen &
/// Stenberg, Math. Comp. 78, 2009; Winter, Schott, Massing & Wall, CMAME 330, 2018, for cut elements and
/// Navier's law): with k = h / gamma_v the tangential terms above are multiplied by k / (k + L), and
/// -(L k / (k + L) / mu (2 mu eps(u) n)_t, (2 mu eps(v) n)_t) is added to `consistent`. It is consistent with
/// (sigma n)_t = -mu / L (u - v_s)_t and as stable for any L as for L = 0.
template <int dim>
void add_interface(const Discretisation<dim>& disc, const Share& share,
                   std::span<const PartGeometry<dim>> geometries, Triplets& consistent, Triplets& penalty);

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

} // namespace undula::fom
