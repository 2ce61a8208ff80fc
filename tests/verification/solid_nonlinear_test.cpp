// Solids at large deformations against published and exact values. All of them in vacuo.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/cook_membrane.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/thin_gap_von_karman.hpp"
#include "tests/verification/support/turek_flag.hpp"

namespace undula::verification {
namespace {

Point<2> displacement_at(const Discretisation<2>& disc, const Eigen::VectorXd& d, const Point<2>& x) {
  return d.segment<2>(disc.solid_unknown(0, node_at(disc, 0, x), 0));
}

/// Equilibrium under loads and imposed displacements that rise in equal steps.
Eigen::VectorXd equilibrium(const Discretisation<2>& disc, const Operators<2>& operators, int load_steps,
                            PhaseTimer& timer) {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady(disc, operators, 1e-10, 1, timer, d, LoadPath{load_steps, {}});
  return d;
}

// --- Turek & Hron, Proposal for numerical benchmarking of fluid-structure interaction, 2006, section 4.2

struct FlagCase {
  const char* name;
  double shear, ux, uy; ///< Pa, m
};

class TurekFlag : public testing::TestWithParam<FlagCase> {};

TEST_P(TurekFlag, HangsAsPublished) {
  const auto [name, shear, ux, uy] = GetParam();
  constexpr double tolerance = 0.002;
  for (const auto& [nx, ny] : {std::pair{70, 4}, std::pair{140, 8}}) {
    PhaseTimer timer;
    const auto disc = turek_flag(nx, ny, shear, 2.0, SolidModel::saint_venant_kirchhoff);
    const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
    const int solves = solve_steady(disc, operators, 1e-10, 1, timer, d);
    const auto tip = displacement_at(disc, d, flag_tip);
    std::printf("%s, %d x %d, %d unknowns, %d iterations: ux %.4f mm (%+.3f %%), uy %.4f mm (%+.3f %%)\n",
                name, nx, ny, disc.unknowns(), solves, 1e3 * tip[0], 100 * (tip[0] / ux - 1), 1e3 * tip[1],
                100 * (tip[1] / uy - 1));
    EXPECT_NEAR(tip[0], ux, tolerance * std::abs(ux));
    EXPECT_NEAR(tip[1], uy, tolerance * std::abs(uy));
  }
}

INSTANTIATE_TEST_SUITE_P(Csm, TurekFlag,
                         testing::Values(FlagCase{"CSM1", 0.5e6, -7.187e-3, -66.10e-3},
                                         FlagCase{"CSM2", 2.0e6, -0.4690e-3, -16.97e-3}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// --- Inflated tube

/// Pressure that widens a neo-Hookean tube (mu 1, inner radius 1 to 1.2, outer 1.3, axial stretch 1.1): by
/// the reaction to the imposed radius, `n` quadrilaterals through the wall.
double tube_pressure(int n, double poisson, bool turned, int load_steps) {
  constexpr double A = 1.0, B = 1.3, a = 1.2, stretch = 1.1, length = 0.3;
  SolidBody<2> body;
  body.mesh = box({A, 0}, {B, length}, n, n);
  if (turned) // a mesh that does not follow the cylinders
    for (auto& x : body.mesh.points) {
      const double r = (x[0] - A) / (B - A), z = x[1] / length;
      const double bump = 0.03 * std::sin(2 * std::numbers::pi * r) * std::sin(2 * std::numbers::pi * z);
      x += Point<2>(bump, -0.7 * bump);
    }
  body.properties = {1.0, 2 * (1 + poisson), poisson, 0.0};
  body.model = SolidModel::neo_hookean;
  body.imposed = [](const Point<2>& x) { return x[0] == A; };
  body.imposed_displacement = [](const Point<2>& x, double) { return Point<2>(a - A, (stretch - 1) * x[1]); };
  auto disc = discretise(in_vacuo(Space::axisymmetric, std::move(body)), CutOptions{});
  BoundaryCondition<2> pull; // the unknowns of a steady state are displacements
  pull.velocity = [](const Point<2>& x, double) { return Point<2>(0, (stretch - 1) * x[1]); };
  hold_component(disc, 0, 1, [](const Point<2>& x) { return x[1] == 0 || x[1] == length; });
  for (auto& constrained : disc.constrained) constrained.condition = &pull;
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const auto d = equilibrium(disc, operators, load_steps, timer);
  const auto residual = steady_residual(disc, operators, d);
  double force = 0;
  for (const auto& node : disc.imposed) force += residual[node.unknown];
  return force / (2 * std::numbers::pi * a * stretch * length);
}

/// b^2 = B^2/l + a^2 - A^2/l, p = (mu/l) ln(la/lb) + mu/(2 l^2) (1/lb^2 - 1/la^2) for an incompressible wall,
/// la = a/A and lb = b/B the hoop stretches inside and outside.
double incompressible_tube_pressure() {
  constexpr double A = 1.0, B = 1.3, a = 1.2, l = 1.1;
  const double b = std::sqrt(B * B / l + a * a - A * A / l), la = a / A, lb = b / B;
  return std::log(la / lb) / l + (1 / (lb * lb) - 1 / (la * la)) / (2 * l * l);
}

TEST(NeoHookeanTube, NeedsTheExactPressure) {
  const double exact = incompressible_tube_pressure();
  EXPECT_NEAR(exact, 0.1250055058, 1e-10);
  for (const bool turned : {false, true})
    for (const int n : {2, 4, 8}) {
      std::printf("tube, %d x %d quadrilaterals%s:", n, n, turned ? ", warped" : "");
      for (const double poisson : {0.49, 0.499, 0.4999, 0.49999}) {
        const double error = tube_pressure(n, poisson, turned, poisson > 0.4999 ? 64 : 8) / exact - 1;
        std::printf(" nu %.6g: %+.4f %%", poisson, 100 * error);
        if (n == 8 && poisson >= 0.4999) {
          EXPECT_LT(std::abs(error), 1e-3);
        }
      }
      std::printf("\n");
    }
}

// --- Near incompressibility

/// Rise of the upper right corner of Cook's membrane, at large deformations: dead load.
double cook_rise(SolidModel model, int n, double poisson) {
  auto body = cook_panel(box({0, 0}, {1, 1}, n, n), poisson);
  body.model = model;
  const auto disc = discretise(in_vacuo(Space::plane, body), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const Eigen::VectorXd load = cook_load(disc);
  LinearSystem<2> system(disc, operators, 1, timer);
  system.assemble({0.0, 1.0, 0.0}, nullptr);
  Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
  constexpr int load_steps = 8;
  Eigen::VectorXd before = d;
  for (int step = 1; step <= load_steps; ++step) {
    const Eigen::VectorXd reached = d;
    d = 2 * reached - before; // along the path so far
    before = reached;
    solve_newton(system, disc, operators, {{1.0, 0.0}, Eigen::VectorXd::Zero(disc.unknowns()), reached},
                 load * (static_cast<double>(step) / load_steps), {}, step, false, d);
  }
  return displacement_at(disc, d, {48, 60})[1];
}

/// Locking is an error that grows as the bulk modulus does, here a hundredfold from 0.49 to 0.4999. Below,
/// the error of no mesh doubles.
TEST(NonlinearCookMembrane, DoesNotLock) {
  struct Convergence {
    double limit;
    std::vector<double> errors; ///< of n = 2, 4, 8, 16, 32
  };
  const auto converge = [](double poisson) {
    std::vector<double> rise;
    for (const int n : {2, 4, 8, 16, 32}) rise.push_back(cook_rise(SolidModel::neo_hookean, n, poisson));
    Convergence result{(rise[2] * rise[4] - rise[3] * rise[3]) / (rise[2] + rise[4] - 2 * rise[3]), {}};
    std::printf("Cook, neo-Hooke, nu = %.4f: limit %.4f;", poisson, result.limit);
    for (std::size_t i = 0; i < rise.size(); ++i) {
      result.errors.push_back(rise[i] / result.limit - 1);
      std::printf(" n = %d: %+.2f %%", 2 << i, 100 * result.errors.back());
    }
    std::printf("\n");
    return result;
  };
  const auto soft = converge(0.49), hard = converge(0.4999);
  for (std::size_t i = 0; i < soft.errors.size(); ++i) {
    EXPECT_LT(soft.errors[i], 0);
    EXPECT_LT(std::abs(hard.errors[i]), 2 * std::abs(soft.errors[i])) << "n = " << (2 << i);
  }
  EXPECT_LT(std::abs(hard.errors[2]), 0.03);
  EXPECT_LT(std::abs(hard.errors[3]), 0.012);
  EXPECT_NEAR(hard.limit / soft.limit, 1, 0.03);
}

/// A clamped ring bent beyond its own thickness, where it carries by stretching as much as by bending.
TEST(ClampedRing, BendsAsVonKarmanSays) {
  constexpr double inner = 0.25, h = 0.01, young = 1.686e7, pressure = 30.0;
  for (const auto model : {SolidModel::saint_venant_kirchhoff, SolidModel::neo_hookean})
    for (const double poisson : {0.3, 0.49, 0.4999}) {
      SolidBody<2> body;
      body.mesh = box({inner, -h / 2}, {1, h / 2}, 150, 2);
      body.properties = {1.125, young, poisson, 0.0};
      body.model = model;
      body.imposed = [](const Point<2>& x) { return x[0] > 1 - 1e-9; };
      body.body_force = [](const Point<2>&, double) { return Point<2>(0.0, pressure / h); };
      const auto disc = discretise(in_vacuo(Space::axisymmetric, std::move(body)), CutOptions{});
      PhaseTimer timer;
      const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
      const auto d = equilibrium(disc, operators, 4, timer);
      const double deflection = displacement_at(disc, d, {inner, 0.0})[1];
      const double exact = VonKarmanPlate{inner, 1.0, h, young, poisson}.deflection(pressure, 10);
      std::printf("ring, %s, nu %.4f: w/h %.4f, von Karman %.4f (%+.3f %%)\n",
                  model == SolidModel::neo_hookean ? "neo-Hooke" : "St Venant-Kirchhoff", poisson,
                  deflection / h, exact / h, 100 * (deflection / exact - 1));
      EXPECT_GT(exact, 1.2 * h);
      EXPECT_NEAR(deflection, exact, 0.01 * exact);
    }
}

// --- Energy

struct SwingEnergy {
  double early = 0, late = 0, tip_range = 0;
};

/// A flag that is struck: velocities of its first mode of vibration, then free. The energy is read after the
/// first quarter of a second, when the scheme has damped the fast modes that the start sets going, and a
/// second later.
SwingEnergy free_swing(SolidModel model, double dt) {
  constexpr double early = 0.25, late = 1.25, tip_speed = 0.6; // s, m/s
  PhaseTimer timer;
  const auto disc = turek_flag(18, 2, 0.5e6, 0.0, model);
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  State state = initial_state(disc);
  const auto rest = turek_flag(18, 2, 0.5e6, 0.0, SolidModel::linear);
  const auto mode = first_vibration(rest, build_operators(rest, PETSC_COMM_SELF, timer)).shape;
  state.x[0] = mode * (tip_speed / displacement_at(disc, mode, flag_tip)[1]);
  SwingEnergy energy;
  TimeStepper<2> stepper(disc, operators, TimeScheme::bdf2, dt, 1, timer);
  for (const int steps :
       {static_cast<int>(std::lround(early / dt)), static_cast<int>(std::lround(late / dt))}) {
    while (state.step < steps) {
      stepper.advance(state);
      energy.tip_range = std::max(energy.tip_range, std::abs(displacement_at(disc, state.d[0], flag_tip)[1]));
    }
    const auto terms = stepper.energy(state, stepper.residual(state));
    energy.early = energy.late;
    energy.late = terms.kinetic + terms.elastic;
  }
  return energy;
}

TEST(FreeSwing, KeepsItsEnergy) {
  const std::pair<SolidModel, std::vector<double>> runs[] = {
      {SolidModel::neo_hookean, {0.01, 0.005, 0.0025}}, {SolidModel::saint_venant_kirchhoff, {0.01, 0.005}}};
  for (const auto& [model, steps] : runs) {
    double coarse = 0;
    for (const double dt : steps) {
      const auto energy = free_swing(model, dt);
      const double loss = 1 - energy.late / energy.early;
      std::printf("free swing, %s, dt %.4f s: tip to %.1f mm, loses %.4f %% of its energy in 1 s",
                  model == SolidModel::neo_hookean ? "neo-Hooke" : "St Venant-Kirchhoff", dt,
                  1e3 * energy.tip_range, 100 * loss);
      if (coarse != 0) std::printf(" (order %.2f)", std::log2(coarse / loss));
      std::printf("\n");
      EXPECT_GT(energy.tip_range, 0.06); // of a length of 0.35: far from linear
      EXPECT_GT(loss, 0);
      if (coarse != 0) {
        EXPECT_GT(std::log2(coarse / loss), 1.8);
      }
      coarse = loss;
    }
    EXPECT_LT(coarse, model == SolidModel::neo_hookean ? 1e-4 : 3e-4);
  }
}

} // namespace
} // namespace undula::verification
