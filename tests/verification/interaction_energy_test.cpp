// Energy balance of the pump on a coarse mesh: exact per step with the scheme's own dissipation, and to 1 %
// over a period without it.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/levels/prepared_scene.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_time.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {
namespace {

Scene coarse_pump(const std::string& scheme, int steps_per_period) {
  const std::vector<std::string> overrides{"mesh.gap_elements=2",
                                           "mesh.channel_size_mm=2.5",
                                           "mesh.membrane_size_mm=0.6",
                                           "mesh.growth=0.6",
                                           "time.scheme=\"" + scheme + "\"",
                                           "time.steps_per_period=" + std::to_string(steps_per_period),
                                           "time.ramp_periods=0.25"};
  return read_scene(std::string(UNDULA_SOURCE_DIR) + "/data/scenes/wave_pump_fixed.toml", overrides);
}

/// What the numerical scheme itself takes, and the change of its energy, over a step.
struct SchemeEnergy {
  const Operators<2>& operators;

  double product(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const {
    return x.dot(operators.mass * x) + d.dot(operators.stiffness * d);
  }
  /// (T x, M x) + (x, K d) times dt by the identities of the schemes: for BDF1 the change of energy plus half
  /// the square of the increment, for BDF2 the change of the G-norm plus a quarter of the second difference's
  /// square.
  double rate_times_dt(const State& now, const State& before, TimeScheme scheme) const {
    const auto &x = now.x, &d = now.d;
    const auto &old_x = before.x[1], &old_d = before.d[1];
    if (scheme == TimeScheme::bdf1 || now.step <= 1)
      return 0.5 * (product(x[0], d[0]) - product(x[1], d[1]) + product(x[0] - x[1], d[0] - d[1]));
    const auto g = [&](const auto& xa, const auto& da, const auto& xb, const auto& db) {
      return product(xa, da) + product(2 * xa - xb, 2 * da - db);
    };
    return 0.25 * (g(x[0], d[0], x[1], d[1]) - g(x[1], d[1], old_x, old_d) +
                   product(x[0] - 2 * x[1] + old_x, d[0] - 2 * d[1] + old_d));
  }
};

class EnergyBalance : public testing::TestWithParam<TimeScheme> {};

TEST_P(EnergyBalance, ClosesPerStepAndOverAPeriod) {
  const auto scheme = GetParam();
  const bool second_order = scheme == TimeScheme::bdf2;
  const auto scene = coarse_pump(second_order ? "bdf2" : "bdf1", 96);
  PhaseTimer timer;
  const auto prepared = prepare_scene(scene, PETSC_COMM_SELF, timer);
  const SchemeEnergy scheme_energy{prepared->operators};
  TimeStepper<2> stepper(prepared->disc, prepared->operators, scheme, time_step(scene), 1, timer);
  State state = initial_state(prepared->disc);
  const double dt = time_step(scene);
  const int start = second_order ? 96 : 0, end = second_order ? 192 : 24;
  double worst = 0, input = 0, dissipated = 0, holder = 0, opening = 0, energy_at_start = 0, energy = 0;
  while (state.step < end) {
    const State before = state;
    stepper.advance(state);
    const auto terms = stepper.energy(state, stepper.residual(state));
    // Energy-neutral openings and skew convection carry nothing; nothing else does work.
    const double scale = std::abs(terms.holder) + std::abs(terms.opening) + terms.viscous + terms.damping;
    EXPECT_NEAR(terms.carried, 0, 1e-10 * scale);
    EXPECT_NEAR(terms.boundary, 0, 1e-10 * scale);
    EXPECT_NEAR(terms.body, 0, 1e-8 * scale);
    EXPECT_GE(terms.viscous + terms.stabilisation, 0);
    EXPECT_GT(terms.damping, 0);
    const double outflow = prepared->operators.openings.at(outlet_name).dot(state.x[0]);
    EXPECT_NEAR(terms.opening, -outlet_pressure(scene, state.time) * outflow, 1e-12 * scale);
    const double step_input = terms.holder + terms.opening;
    const double step_loss = terms.viscous + terms.stabilisation + terms.damping;
    const double rate = scheme_energy.rate_times_dt(state, before, scheme) / dt;
    worst = std::max(worst, std::abs(step_input - step_loss - rate) / scale);
    energy = terms.kinetic + terms.elastic;
    if (state.step == start) energy_at_start = energy;
    if (state.step <= start) continue;
    input += dt * step_input;
    holder += dt * terms.holder;
    opening += dt * terms.opening;
    dissipated += dt * step_loss;
  }
  const double open = input - dissipated - (energy - energy_at_start);
  std::printf(
      "pump, %d unknowns, BDF%d: balance per step %.1e; over %d steps: holder %.4e, opening %.4e, dissipated "
      "%.4e, stored %.4e erg, not accounted for %.3f %% of the holder's work; %.1f ms per step\n",
      prepared->disc.unknowns(), second_order ? 2 : 1, worst, end - start, holder, opening, dissipated,
      energy - energy_at_start, 100 * open / holder,
      1e3 * (timer.records().at("factor").seconds + timer.records().at("solve").seconds) / end);
  EXPECT_LT(worst, 1e-7);
  EXPECT_GT(holder, 0);
  EXPECT_NE(opening, 0);
  // BDF1 takes so much itself that the balance does not close without its dissipation.
  if (second_order)
    EXPECT_LT(std::abs(open), 0.01 * holder);
  else
    EXPECT_GT(open, 0.03 * holder);
}

INSTANTIATE_TEST_SUITE_P(Schemes, EnergyBalance, testing::Values(TimeScheme::bdf1, TimeScheme::bdf2),
                         [](const auto& instance) {
                           return instance.param == TimeScheme::bdf1 ? "Bdf1" : "Bdf2";
                         });

} // namespace
} // namespace undula::verification
