// What the flow does to blood, as far as stress and residence tell: the scalar stress, and the power law of
// haemolysis weighted by residence.
//
// The scalar stress is tau = viscosity * sqrt(2 D : D), D the rate of deformation with its hoop. The law is
// measured in steady shear: free haemoglobin in percent = coefficient * tau^stress_exponent *
// t^time_exponent, tau in Pa and t in s (Giersiepen et al. 1990). Its time exponent below 1 makes damage add
// up in (damage)^(1 / time_exponent), linear in time (Garon & Farinas 2004): blood that passes at the flow Q
// comes to
//   percent = (rate / Q)^time_exponent,   rate = integral over the fluid of (coefficient tau^a)^(1 / b).
// Stress laws miss absolute haemolysis by orders of magnitude (Dirkes & Behr, arXiv:2601.19994), and the
// addition supposes that all blood sees the same (Faghih & Sharp 2019): for comparing designs alone.
#pragma once

#include "fom/problem/blood_damage_law.hpp"
#include "fom/space/discretisation.hpp"

namespace undula::fom {

struct BloodStress {
  double maximum = 0;         ///< dyn/cm^2, over elements
  double damage_rate = 0;     ///< cm^3/s percent^(1 / time_exponent): `rate` above
  double stressed_volume = 0; ///< cm^3 beyond the threshold
};

/// Of the velocities in `x` (all unknowns).
template <int dim>
BloodStress blood_stress(const Discretisation<dim>& disc, const BloodDamageLaw& law,
                         const Eigen::VectorXd& x);

/// Percent of free haemoglobin after one pass, for a mean rate and a mean flow (cm^3/s); NaN without a flow
/// out of the outlet.
double haemolysis_percent(const BloodDamageLaw& law, double damage_rate, double flow);

} // namespace undula::fom
