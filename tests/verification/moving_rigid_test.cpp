// The moving cut on exact flows: the fluid moves with a rigid body, in translation and in rotation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fom/coupling/moving_stepper.hpp"
#include "fom/problem/default_weights.hpp"
#include "fom/scene/scene.hpp"
#include "fom/time/reaction.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

/// A motion of the whole plane as a rigid body, at time t.
struct RigidMotion {
  std::function<Point<2>(const Point<2>& at_rest, double t)> place;
  VectorField<2> velocity; ///< of the place x
};

constexpr double density = 1.3, start = 10;

/// The unit square with fluid that follows `motion` on its four sides, about a turned plate thinner than an
/// element that does the same; from the exact history.
struct MovingPlate {
  MovingPlate(const RigidMotion& rigid, int n, double step, Coupling coupling = Coupling::explicit_)
      : motion(rigid), dt(step) {
    FsiProblem<2> problem;
    problem.fluid = {density, 0.05};
    problem.stabilisation = derived_weights(1.0, 1.0);
    problem.background = warped_square(n);
    for (const auto& name : problem.background.boundary_names)
      problem.boundary[name].velocity = motion.velocity;
    problem.pin_pressure = true;
    SolidBody<2> plate;
    plate.mesh = turned_box({0.47, 0.52}, 0.2, 0.02, 0.3, 20, 2);
    plate.properties = {1.0, 1e5, 0.3};
    plate.imposed = [](const Point<2>&) { return true; };
    plate.imposed_displacement = [this](const Point<2>& x, double t) { return motion.place(x, t) - x; };
    problem.solids.push_back(plate);
    disc = discretise(std::move(problem), {});
    operators = build_operators(disc, MPI_COMM_SELF, timer);

    // The exact history, on the cut of its last instant.
    state = initial_state(disc);
    state.step = static_cast<int>(start);
    state.time = state.step * dt;
    state.placement = displacement(state.time);
    const CutOptions options;
    disc = recut(disc, state.placement, options);
    for (int level : {0, 1}) {
      const double t = state.time - level * dt;
      state.x[level] = exact(t);
      state.d[level] = Eigen::VectorXd::Zero(disc.unknowns());
      state.d[level].tail(disc.solid_unknowns()) = displacement(t);
    }
    TimeSettings settings;
    settings.motion.tolerance = 1e-9;
    stepper.emplace(disc, operators, coupling, settings, ContactSettings{}, dt, timer, state);
  }

  Eigen::VectorXd displacement(double t) const {
    Eigen::VectorXd d(disc.solid_unknowns());
    const auto& nodes = disc.solid_spaces[0].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      d.segment<2>(static_cast<Eigen::Index>(2 * i)) = motion.place(nodes[i], t) - nodes[i];
    return d;
  }

  /// Velocities only.
  Eigen::VectorXd exact(double t) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
    for (std::size_t i = 0; i < disc.fluid_nodes.dof_point.size(); ++i)
      x.segment<2>(disc.velocity_unknown(static_cast<int>(i), 0)) =
          motion.velocity(disc.cut.mesh.points[disc.fluid_nodes.dof_point[i]], t);
    const auto& nodes = disc.solid_spaces[0].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      x.segment<2>(disc.solid_unknown(0, static_cast<int>(i), 0)) =
          motion.velocity(motion.place(nodes[i], t), t);
    return x;
  }

  /// Root mean square over the fluid's area.
  double velocity_error() const {
    const Eigen::VectorXd difference = state.x[0] - exact(state.time);
    double sum = 0, area = 0;
    for (const int part : operators.own_parts) {
      const auto local = VelocityElement<2, 1>::coefficients(disc, part, difference);
      sum += (local * operators.moments[part] * local.transpose()).trace();
      area += operators.moments[part].sum();
    }
    return std::sqrt(sum / area);
  }

  RigidMotion motion;
  double dt;
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
  State state;
  std::optional<MovingStepper<2>> stepper;
};

/// v = (0.3, -0.2) + t (0.5, 0.8): the fluid is at rest in the frame of the body. Everything is in the
/// spaces.
RigidMotion translation() {
  return {[](const Point<2>& x, double t) -> Point<2> {
            return x + Point<2>(0.3, -0.2) * (t - 0.25) + Point<2>(0.25, 0.4) * (t * t - 0.0625);
          },
          [](const Point<2>&, double t) -> Point<2> { return Point<2>(0.3 + 0.5 * t, -0.2 + 0.8 * t); }};
}

/// About (0.5, 0.5): a flow of solid rotation.
RigidMotion rotation() {
  const double rate = 2.0;
  const Point<2> centre(0.5, 0.5);
  return {[=](const Point<2>& x, double t) -> Point<2> {
            const double angle = rate * (t - 0.25);
            const Point<2> r = x - centre;
            return centre + Point<2>(std::cos(angle) * r[0] - std::sin(angle) * r[1],
                                     std::sin(angle) * r[0] + std::cos(angle) * r[1]);
          },
          [=](const Point<2>& x, double) -> Point<2> {
            return rate * Point<2>(-(x[1] - centre[1]), x[0] - centre[0]);
          }};
}

TEST(MovingCut, TranslatesWithTheFluidToRounding) {
  for (const auto coupling : {Coupling::explicit_, Coupling::implicit}) {
    MovingPlate plate(translation(), 12, 0.025, coupling);
    int extended = 0;
    for (int step = 0; step < 20; ++step) {
      plate.stepper->advance(plate.state);
      extended += plate.stepper->report().new_nodes;
    }
    const double error = plate.velocity_error();
    // Accelerated fluid lifts a body as a still one does in gravity.
    const auto force = force_on_solid(plate.disc, plate.operators, plate.state.x[0], 0);
    const double lifted = density * 0.4 * 0.04;
    std::printf("translation: error %.1e, force / (density * area) %.6f %.6f, %d new nodes\n", error,
                force[0] / lifted, force[1] / lifted, extended);
    EXPECT_GT(extended, 10);
    EXPECT_LT(error, 1e-9);
    EXPECT_NEAR(force[0] / lifted, 0.5, 1e-6);
    EXPECT_NEAR(force[1] / lifted, 0.8, 1e-6);
  }
}

TEST(MovingCut, RotatesWithTheFluidAtSecondOrder) {
  double coarse = 0;
  for (const int n : {8, 16, 32}) {
    MovingPlate plate(rotation(), n, 0.2 / n);
    for (int step = 0; step < n; ++step) plate.stepper->advance(plate.state);
    const double error = plate.velocity_error();
    std::printf("rotation: n %d, error %.3e, order %.2f\n", n, error, std::log2(coarse / error));
    if (n == 32) {
      EXPECT_GT(std::log2(coarse / error), 1.8);
    }
    coarse = error;
  }
}

} // namespace
} // namespace undula::verification
