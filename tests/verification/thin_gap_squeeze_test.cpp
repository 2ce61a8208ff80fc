// Squeeze films between a rigid annulus and a wall: force of the actuator against lubrication theory and
// against the oscillating flow between two plates.
#include <gtest/gtest.h>

#include <complex>
#include <cstdio>
#include <numbers>

#include "fom/levels/march.hpp"
#include "fom/levels/thin_gap_level.hpp"
#include "fom/scene/scene_time.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/thin_gap_scene.hpp"

namespace undula::verification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double inner = 0.5, outer = 1.9, gap = 0.02; // cm; the gap below, at rest

struct Film {
  bool closed_outside = false;         ///< else p = 0 at both rims
  FluidProperties fluid = {1e-6, 1.0}; ///< g/cm^3, poise
  double stroke = 0.4 * gap;           ///< cm
  double momentum_factor = 1;
  int cells = 96;
};

/// Geometry G of the force 12 mu V / h^3 * G on the annulus, cm^4.
double force_geometry(bool closed_outside) {
  const double a = inner * inner, b = outer * outer;
  if (closed_outside) // p' ~ (R2^2 - r^2) / r
    return pi / 2 * ((b * b - a * a) / 4 - b * (b - a) + b * b * std::log(outer / inner));
  return pi / 8 * (b * b - a * a - (b - a) * (b - a) / std::log(outer / inner));
}

/// One period of a film of which the plate's whole area is held: velocity, gap and force by step. The plate
/// weighs nothing and the gap above is wide.
struct FilmRecord {
  std::vector<double> time, velocity, gap, force;
};
FilmRecord film(const Film& film) {
  constexpr int steps = 96, periods = 3;
  Scene scene;
  scene.space = Space::thin_gap;
  scene.coupling = Coupling::implicit;
  scene.flow = FlowModel::stokes;
  scene.fluid = film.fluid;
  scene.membrane = {1e-12, 1e7, 0.49, 0.0};
  scene.operating_point = {
      film.fluid.density < 1e-3 ? 1.0 : film.fluid.viscosity / film.fluid.density / (2 * pi * gap * gap),
      film.stroke, 0.0, 1.0};
  scene.time.steps_per_period = steps;
  scene.time.periods = periods;
  scene.time.ramp_periods = 1;
  scene.thin_gap.film_thickness = 1e-4 * gap;
  scene.thin_gap.momentum_factor = film.momentum_factor;
  scene.thin_gap.newton_tolerance = 1e-9;
  ThinGapModel model{even_layout(inner, outer, film.cells, 0, film.cells - 1, 0.1, 1e3 * gap, gap)};
  if (film.closed_outside) model.layout.rim.resistance = 1e15;
  State state = initial_state(model);
  PhaseTimer timer;
  FilmRecord record;
  ThinGapLevel level(model);
  march(level, scene, state, timer, [&](const State& now, const Observation& seen) {
    if (now.step <= (periods - 1) * steps) return;
    const double velocity = // what the scheme makes of the holder's motion
        steps * scene.operating_point.frequency *
        (1.5 * now.d[0][0] - 2 * now.d[1][0] +
         0.5 * scene.operating_point.stroke *
             std::sin(2 * pi * scene.operating_point.frequency * now.time - 4 * pi / steps));
    record.time.push_back(now.time);
    record.velocity.push_back(velocity);
    record.gap.push_back(gap + seen.holder.displacement);
    record.force.push_back(seen.energy.holder / velocity);
  });
  return record;
}

class SqueezeFilm : public testing::TestWithParam<bool> {};

TEST_P(SqueezeFilm, ResistsAsLubricationTheorySays) {
  const bool closed_outside = GetParam();
  double worst = 0;
  for (const int cells : {48, 96}) {
    Film given;
    given.closed_outside = closed_outside;
    given.cells = cells;
    const auto record = film(given);
    worst = 0;
    double least = gap, most = 0, top = 0;
    for (const double v : record.velocity) top = std::max(top, std::abs(v));
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      if (std::abs(record.velocity[i]) < 0.1 * top) continue; // force over velocity
      const double exact = 12 * given.fluid.viscosity * record.velocity[i] / std::pow(record.gap[i], 3) *
                           force_geometry(closed_outside);
      worst = std::max(worst, std::abs(record.force[i] / exact - 1));
      least = std::min(least, record.gap[i]);
      most = std::max(most, record.gap[i]);
    }
    std::printf(
        "squeeze film, %s, %d cells: worst error of the force over a period %.4f %% (gaps %.4f .. %.4f cm)\n",
        closed_outside ? "closed outside" : "open at both rims", cells, 100 * worst, least, most);
    EXPECT_LT(least, 0.65 * gap); // the cube of the gap is tested, not its value at rest
  }
  EXPECT_LT(worst, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Rims, SqueezeFilm, testing::Values(false, true), [](const auto& instance) {
  return std::string(instance.param ? "ClosedOutside" : "OpenAtBothRims");
});

/// Small oscillation at omega gap^2 / nu = 1: the pressure gradient of a flow between two plates is
/// i omega rho u / (1 - tanh(z) / z), z = gap/2 sqrt(i omega / nu), which begins as 12 mu / gap^2 + 6/5 i
/// omega rho: the inertia of a parabola.
TEST(SqueezeFilmInertia, HasTheMomentumOfAParabola) {
  using Complex = std::complex<double>;
  Film given;
  given.fluid = {1.0, 0.035};
  given.stroke = 1e-4 * gap;
  double error[2];
  for (const bool parabola : {true, false}) {
    given.momentum_factor = parabola ? 1.2 : 1.0;
    const auto record = film(given);
    const double omega = given.fluid.viscosity / given.fluid.density / (gap * gap);
    Complex velocity = 0, force = 0;
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      velocity += record.velocity[i] * std::exp(Complex(0, -omega * record.time[i]));
      force += record.force[i] * std::exp(Complex(0, -omega * record.time[i]));
    }
    const Complex z = gap / 2 * std::sqrt(Complex(0, omega * given.fluid.density / given.fluid.viscosity));
    const Complex exact =
        Complex(0, omega * given.fluid.density) / (1.0 - std::tanh(z) / z) / gap * force_geometry(false);
    const Complex measured = force / velocity;
    error[parabola ? 0 : 1] = std::abs(measured / exact - 1.0);
    std::printf(
        "oscillating squeeze film, momentum factor %.1f: force per velocity %.2f %+.3fi, exact %.2f %+.3fi "
        "g/s (%.3f %%)\n",
        given.momentum_factor, measured.real(), measured.imag(), exact.real(), exact.imag(),
        100 * error[parabola ? 0 : 1]);
  }
  EXPECT_LT(error[0], 0.005);
  EXPECT_GT(error[1], 0.01); // a plug has less
}

} // namespace
} // namespace undula::verification
