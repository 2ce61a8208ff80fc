#include "fom/output/blood_stress.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fom/assembly/part_quadrature.hpp"
#include "fom/space/velocity_element.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {

template <int dim>
BloodStress blood_stress(const Discretisation<dim>& disc, const BloodDamageLaw& law,
                         const Eigen::VectorXd& x) {
  BloodStress stress;
  // The rate of strain is constant on an element, or linear.
  const auto rule = reference_rule<dim>(disc.problem.velocity_order);
  const bool hoop = disc.problem.space == Space::axisymmetric;
  const double per_pascal = std::pow(law.coefficient, 1 / law.time_exponent);
  const double exponent = law.stress_exponent / law.time_exponent;
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    const auto geometry = part_geometry(disc, part);
    for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& at, double weight) {
      const auto [velocity, gradient] = sample_velocity(disc, part, geometry.gradients, lambda, x);
      const double in_plane = (0.5 * (gradient + gradient.transpose())).squaredNorm();
      const double stretch = hoop && at[0] > 0 ? velocity[0] / at[0] : 0;
      const double tau = disc.problem.fluid.viscosity * std::sqrt(2 * (in_plane + stretch * stretch));
      stress.maximum = std::max(stress.maximum, tau);
      stress.damage_rate += weight * per_pascal * std::pow(units::pressure_to_Pa(tau), exponent);
      if (tau > law.threshold) stress.stressed_volume += weight;
    });
  }
  return stress;
}

double haemolysis_percent(const BloodDamageLaw& law, double damage_rate, double flow) {
  if (!(flow > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::pow(damage_rate / flow, law.time_exponent);
}

template BloodStress blood_stress(const Discretisation<2>&, const BloodDamageLaw&, const Eigen::VectorXd&);

template BloodStress blood_stress(const Discretisation<3>&, const BloodDamageLaw&, const Eigen::VectorXd&);

} // namespace undula::fom
