// The power law of haemolysis, as measured in steady shear.
#pragma once

namespace undula::fom {

/// Free haemoglobin in percent = coefficient * stress^stress_exponent * seconds^time_exponent, the stress in
/// Pa. Zhang et al. 2011: 1.228e-5, 1.9918, 0.6606; Giersiepen et al. 1990: 3.62e-5, 2.416, 0.785; Heuser &
/// Opitz 1980: 1.8e-6, 1.991, 0.765.
struct BloodDamageLaw {
  double coefficient = 0; ///< percent / (Pa^stress_exponent s^time_exponent)
  double stress_exponent = 0;
  double time_exponent = 0;
  double threshold = 0; ///< dyn/cm^2, stress beyond which the volume is counted
};

} // namespace undula::fom
