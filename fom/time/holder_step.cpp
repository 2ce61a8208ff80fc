#include "fom/time/holder_step.hpp"

namespace undula::fom {

HolderStep holder_step(const DrivenHolder& holder, const std::array<double, 3>& alpha, double dt, double t,
                       const State& state, int unknown, double about) {
  const auto& actuator = holder.actuator;
  const double per_velocity = dt / alpha[0]; // of displacement at the end, cm per cm/s
  const double displacement =
      per_velocity * about - (alpha[1] * state.d[0][unknown] + alpha[2] * state.d[1][unknown]) / alpha[0];
  const auto resistance = holder_resistance(actuator, displacement, about);
  const double resisting = resistance.by_velocity + resistance.by_displacement * per_velocity;
  const double momentum = actuator.moving_mass / dt; // per velocity
  HolderStep step;
  step.by_velocity = momentum * alpha[0] + resisting;
  step.force = driving_force(actuator, holder.voltage(t)) -
               momentum * (alpha[1] * state.x[0][unknown] + alpha[2] * state.x[1][unknown]) -
               (resistance.force - resisting * about);
  return step;
}

} // namespace undula::fom
