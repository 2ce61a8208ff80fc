#include "fom/time/holder_step.hpp"

#include "fom/actuator/holder_terms.hpp"

namespace undula::fom {

HolderStep holder_step(const DrivenHolder& holder, const std::array<double, 3>& alpha, double dt, double t,
                       const State& state, int unknown, double about) {
  const auto history = [&](const auto& levels) {
    return alpha[1] * levels[0][unknown] + alpha[2] * levels[1][unknown];
  };
  HolderMotion motion;
  motion.rate = alpha[0] / dt;
  motion.velocity = about;
  motion.displacement = (dt * about - history(state.d)) / alpha[0];
  motion.acceleration = (alpha[0] * about + history(state.x)) / dt;
  const HolderTerms terms = holder_terms(holder.actuator, holder.voltage(t), motion);
  HolderStep step;
  step.by_velocity = terms.by_velocity;
  step.force = terms.by_velocity * about - terms.force;
  return step;
}

} // namespace undula::fom
