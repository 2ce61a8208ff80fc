// Momentum of the flow in gaps and passages, in the form of pressures along a stream tube.
#pragma once

#include <algorithm>
#include <cmath>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Closures of the flow in force, cgs.
struct GapFlowLaw {
  double density = 0, viscosity = 0;
  double momentum_factor = 1;
  double throat_recovery = 0, exit_recovery = 0, entry_loss = 0;
  double stokes_layer = 0;     ///< cm, sqrt(2 nu / omega); 0: friction of the developed profile throughout
  double turning_velocity = 0; ///< cm/s, below which losses change smoothly with the direction of the flow
  double least_height = 0;     ///< cm, on which the height of the flow levels out where solids meet
  bool convective = true;      ///< false: Stokes flow, without kinetic terms and losses
};

/// The height that the flow sees: `height` where it is open, positive where solids overlap.
template <typename Number>
Number open_height(const GapFlowLaw& law, const Number& height) {
  using std::sqrt;
  return 0.5 * (height + sqrt(height * height + 4 * law.least_height * law.least_height));
}

/// Pressure gradient that wall friction takes at unit mean velocity, g/(cm^3 s).
template <typename Number>
Number gap_friction(const GapFlowLaw& law, const Number& height) {
  const Number developed = 12 * law.viscosity / (height * height);
  if (law.stokes_layer > 0 && height > 6 * law.stokes_layer)
    return 2 * law.viscosity / (height * law.stokes_layer);
  return developed;
}

/// Kinetic pressure at mean velocity u.
template <typename Number>
Number kinetic_pressure(const GapFlowLaw& law, const Number& u) {
  return 0.5 * law.density * law.momentum_factor * u * u;
}

/// -1 .. 1 with the direction of a flow.
template <typename Number>
Number direction(const GapFlowLaw& law, const Number& velocity) {
  using std::tanh;
  return Number(tanh(Number(velocity / law.turning_velocity)));
}

/// Pressure that flow at `velocity` needs to change its kinetic pressure from `before` to `after` (in the
/// direction of the coordinate): Bernoulli where it speeds up, the recovered part where it slows down.
template <typename Number>
Number convective_drop(const GapFlowLaw& law, const Number& velocity, const Number& before,
                       const Number& after) {
  using std::sqrt;
  if (!law.convective) return Number(0.0 * before);
  const double smooth = law.density * law.turning_velocity * law.turning_velocity;
  const Number sign = direction(law, velocity);
  const Number gain = sign * (after - before); // along the flow
  const Number speeding_up = 0.5 * (gain + sqrt(Number(gain * gain + smooth * smooth)) - smooth);
  return Number(sign * (law.throat_recovery * gain + (1 - law.throat_recovery) * speeding_up));
}

/// The same where a gap begins (in the direction of the coordinate) at a chamber at rest; `kinetic` is the
/// kinetic pressure in the gap.
template <typename Number>
Number drop_at_beginning(const GapFlowLaw& law, const Number& velocity, const Number& kinetic) {
  if (!law.convective) return Number(0.0 * kinetic);
  const Number into = 0.5 * (1 + direction(law, velocity));
  return Number(kinetic * ((1 + law.entry_loss) * into + law.exit_recovery * (1 - into)));
}

/// And where a gap ends at a chamber at rest.
template <typename Number>
Number drop_at_end(const GapFlowLaw& law, const Number& velocity, const Number& kinetic) {
  return Number(-drop_at_beginning(law, Number(-velocity), kinetic));
}

} // namespace undula::fom
