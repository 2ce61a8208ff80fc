// Weak forms on a cut mesh against integrals known in closed form.
#include <gtest/gtest.h>

#include <random>

#include "fom/system/operators.hpp"
#include "geometry/wave_pump/membrane_outline.hpp"
#include "geometry/wave_pump/pump.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double pi = std::numbers::pi;

struct Channel {
  explicit Channel(const Elements& elements, OpeningCondition outlet = OpeningCondition::total_pressure) {
    auto problem = channel_with_plate(elements);
    problem.boundary.at(outlet_name).opening = outlet;
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, MPI_COMM_SELF, timer);
  }
  /// a . C(b) a
  double convected(const Eigen::VectorXd& b, const Eigen::VectorXd& a) const {
    double sum = 0;
    visit_convection(disc, operators, b, [&](int i, int j, double value) { sum += a[i] * value * a[j]; });
    return sum;
  }
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
};

Point<2> upwards(const Point<2>&) { return {0.0, 1.0}; }
Point<2> downwards(const Point<2>&) { return {0.0, -1.0}; }

Eigen::VectorXd random_vector(Eigen::Index size, int seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::VectorXd x(size);
  for (auto& entry : x) entry = value(generator);
  return x;
}

class Forms : public testing::TestWithParam<Elements> {};

TEST_P(Forms, ConvectionDoesNoWorkWhateverTheFieldIs) {
  const Channel channel(GetParam());
  const auto b = random_vector(channel.disc.unknowns(), 1), a = random_vector(channel.disc.unknowns(), 2);
  double size = 0, work = 0;
  visit_convection(channel.disc, channel.operators, b, [&](int i, int j, double value) {
    size += std::abs(a[i] * value * a[j]);
    work += a[i] * value * a[j];
  });
  EXPECT_GT(size, 1e-3);
  EXPECT_NEAR(work, 0, 1e-13 * size);
}

/// The convection of a shear flow by an axial one: rho (b.grad) u tested with v, both linear or less.
TEST_P(Forms, ConvectionTransportsMomentum) {
  const Channel channel(GetParam());
  const auto b = interpolate_velocity(channel.disc, upwards);
  const auto u = interpolate_velocity(channel.disc, [](const Point<2>& x) { return Point<2>(0, x[1]); });
  const auto v =
      interpolate_velocity(channel.disc, [](const Point<2>& x) { return Point<2>(0, x[1] * (0.6 - x[1])); });
  const auto w = interpolate_velocity(channel.disc, [](const Point<2>&) { return Point<2>(0, 0.3); });
  double skew_of_constants = 0, skew = 0;
  visit_convection(channel.disc, channel.operators, b, [&](int i, int j, double value) {
    skew += v[i] * value * u[j];
    skew_of_constants += w[i] * value * u[j];
  });
  // rho/2 [(u', w) - (w', u)] = rho/2 * 0.3 * volume of the fluid, exactly.
  const Eigen::VectorXd one = interpolate_velocity(channel.disc, upwards);
  const Eigen::VectorXd fluid_one = (Eigen::VectorXd(one.size()) << one.head(channel.disc.fluid_unknowns()),
                                     Eigen::VectorXd::Zero(one.size() - channel.disc.fluid_unknowns()))
                                        .finished();
  const double volume = fluid_one.dot(channel.operators.mass * fluid_one);
  EXPECT_NEAR(skew_of_constants, 0.5 * 0.3 * volume, 1e-12 * volume);
  EXPECT_NE(skew, 0.0);
}

/// The penalty that the local velocity scales: nothing for linear fields or a fluid at rest, positive and
/// proportional to the velocity else; in a uniform stream no more than with that speed as the reference.
TEST_P(Forms, JumpsScaledByTheLocalVelocity) {
  auto problem = channel_with_plate(GetParam());
  const double speed = 3.0;
  problem.stabilisation.velocity_scale = VelocityScale::local;
  PhaseTimer timer;
  const auto disc = discretise(problem, CutOptions{});
  const auto local = build_operators(disc, MPI_COMM_SELF, timer);
  const auto penalty = [&](double scale, const Eigen::VectorXd& a) {
    const auto b = interpolate_velocity(disc, [&](const Point<2>&) { return Point<2>(0, scale * speed); });
    double sum = 0, size = 0;
    visit_velocity_jumps<2>(disc, local.velocity_jumps, b, [&](int i, int j, double value) {
      sum += a[i] * value * a[j];
      size += std::abs(a[i] * value * a[j]);
    });
    return std::pair(sum, size);
  };
  const auto linear = interpolate_velocity(
      disc, [](const Point<2>& x) { return Point<2>(x[0] - 2 * x[1], 0.3 + x[0] + 4 * x[1]); });
  EXPECT_NEAR(penalty(1, linear).first, 0, 1e-12 * penalty(1, linear).second);
  const auto wild = random_vector(disc.unknowns(), 3);
  EXPECT_EQ(penalty(0, wild).first, 0);
  EXPECT_GT(penalty(1, wild).first, 0);
  EXPECT_NEAR(penalty(2, wild).first, 2 * penalty(1, wild).first, 1e-12 * penalty(2, wild).second);

  problem.stabilisation.velocity_scale = VelocityScale::reference;
  problem.stabilisation.reference_velocity = speed;
  const auto everywhere = build_operators(discretise(problem, CutOptions{}), MPI_COMM_SELF, timer);
  EXPECT_TRUE(everywhere.velocity_jumps.empty());
  problem.stabilisation.velocity_jump = 0;
  const auto without = build_operators(discretise(problem, CutOptions{}), MPI_COMM_SELF, timer);
  // phi, too, knows the reference velocity, but is the same in both.
  const double most = wild.dot(everywhere.stabilisation * wild - without.stabilisation * wild);
  EXPECT_LT(penalty(1, wild).first, most);
  EXPECT_GT(penalty(1, wild).first, 0.3 * most);
}

/// All penalties on the fluid vanish for fields that the elements hold, to the last bit of their degree: what
/// they leave of the next one is seen.
TEST_P(Forms, JumpsVanishForPolynomialsOfTheDegree) {
  auto problem = channel_with_plate(GetParam());
  problem.solids[0].mesh = box({-0.2, 0.283}, {1.2, 0.331}, 10, 2); // cuts every column of elements
  problem.stabilisation.velocity_scale = VelocityScale::reference;
  PhaseTimer timer;
  const auto disc = discretise(problem, CutOptions{});
  const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
  const auto penalty = [&](auto&& field) {
    const auto x = interpolate_velocity(disc, field);
    return std::pair(x.dot(operators.stabilisation * x),
                     x.cwiseAbs().dot(operators.stabilisation.cwiseAbs() * x.cwiseAbs()));
  };
  const auto linear = penalty([](const Point<2>& x) { return Point<2>(x[0] - 2 * x[1], 1 + x[0] + x[1]); });
  const auto square =
      penalty([](const Point<2>& x) { return Point<2>(x[0] * x[1], x[1] * x[1] - 2 * x[0] * x[0]); });
  const auto cube = penalty([](const Point<2>& x) { return Point<2>(x[1] * x[1] * x[1], 0.0); });
  EXPECT_NEAR(linear.first, 0, 1e-13 * linear.second);
  if (GetParam().velocity_order == 2) {
    EXPECT_NEAR(square.first, 0, 1e-13 * square.second);
  } else {
    EXPECT_GT(square.first, 1e-9 * square.second);
  }
  EXPECT_GT(cube.first, 1e-9 * cube.second);
}

TEST_P(Forms, MassIsDensityTimesVolume) {
  const Channel channel(GetParam());
  const bool round = GetParam().space == Space::axisymmetric;
  const auto area = [&](double inner, double outer) {
    return round ? pi * (outer * outer - inner * inner) : outer - inner;
  };
  const double plate = area(Sizes::plate_inner, Sizes::plate_outer) * (Sizes::plate_high - Sizes::plate_low);
  const double fluid = area(0, Sizes::radius) * Sizes::height - plate;
  for (int component : {0, 1}) {
    Eigen::VectorXd one = interpolate_velocity(
        channel.disc, [&](const Point<2>&) { return Point<2>(Point<2>::Unit(component)); });
    const int split = channel.disc.fluid_unknowns();
    const Eigen::VectorXd momentum = channel.operators.mass * one;
    EXPECT_NEAR(one.head(split).dot(momentum.head(split)), 1.0 * fluid, 1e-12 * fluid);
    EXPECT_NEAR(one.tail(one.size() - split).dot(momentum.tail(one.size() - split)), 1.125 * plate,
                1e-12 * plate);
  }
}

TEST_P(Forms, OpeningsMeasureTheFlowOutward) {
  const Channel channel(GetParam());
  const double area =
      GetParam().space == Space::axisymmetric ? pi * Sizes::radius * Sizes::radius : Sizes::radius;
  const auto x = interpolate_velocity(channel.disc, downwards);
  EXPECT_NEAR(channel.operators.openings.at(outlet_name).dot(x), area, 1e-13);
  EXPECT_NEAR(channel.operators.openings.at(inlet_name).dot(x), -area, 1e-13);
  // First moment of a linear profile: int r dA = 2 pi R^3 / 3.
  const auto linear =
      interpolate_velocity(channel.disc, [](const Point<2>& p) { return Point<2>(0, -p[0]); });
  EXPECT_NEAR(channel.operators.openings.at(outlet_name).dot(linear),
              GetParam().space == Space::axisymmetric ? 2 * pi / 3 : 0.5, 1e-13);
}

/// Fluid and solid moving up together: no strain, no jump, no force anywhere but by inertia.
TEST_P(Forms, RigidTranslationGivesNoForce) {
  const Channel channel(GetParam());
  const auto together = interpolate_velocity(channel.disc, upwards);
  const auto& operators = channel.operators;
  for (const SparseMatrix* matrix :
       {&operators.physical, &operators.stabilisation, &operators.damping, &operators.stiffness}) {
    double largest = 0;
    for (int row = 0; row < matrix->outerSize(); ++row)
      for (SparseMatrix::InnerIterator entry(*matrix, row); entry; ++entry)
        largest = std::max(largest, std::abs(entry.value()));
    EXPECT_LT((*matrix * together).lpNorm<Eigen::Infinity>(), 1e-11 * largest);
  }
  // The plate alone: the interface resists, with the power of the penalty on its skin.
  Eigen::VectorXd plate = together;
  plate.head(channel.disc.fluid_unknowns()).setZero();
  EXPECT_GT(plate.dot(operators.stabilisation * plate), 1.0);
  EXPECT_GT((operators.physical * plate).norm(), 0.01);
}

/// A uniform pressure: the fluid is at rest, and the skin of the solid carries p n.
TEST_P(Forms, UniformPressureLoadsTheSkin) {
  const Channel channel(GetParam());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(channel.disc.unknowns());
  for (int node = 0; node < channel.disc.vertex_nodes(); ++node) x[channel.disc.pressure_unknown(node)] = 1.0;
  const Eigen::VectorXd force = -(channel.operators.physical * x);
  // Power on a solid that shrinks like v = -(x, z) (plane) or -(r, z): pressure times the rate of its volume.
  const auto shrinking = interpolate_velocity(channel.disc, [](const Point<2>& p) { return Point<2>(-p); });
  const int split = channel.disc.fluid_unknowns();
  const double power = shrinking.tail(shrinking.size() - split).dot(force.tail(shrinking.size() - split));
  const bool round = GetParam().space == Space::axisymmetric;
  const double thickness = Sizes::plate_high - Sizes::plate_low;
  const double volume = round ? pi * (0.64 - 0.09) * thickness : 0.5 * thickness;
  EXPECT_NEAR(power, (round ? 3 : 2) * volume, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Elements, Forms, testing::ValuesIn(all_elements),
                         [](const auto& instance) { return instance.param.name(); });

/// Kinetic energy carried out of the outlet by a uniform stream of 1 cm/s: rho/2 * area, unless the opening
/// is energy-neutral, or the stream enters where entering is neutral.
class Openings : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, Openings, testing::Values(1, 2));

TEST_P(Openings, CarryKineticEnergyAsTheirConditionSays) {
  const double carried = 0.5 * pi;
  const int velocity_order = GetParam();
  const auto work = [velocity_order](OpeningCondition condition, Point<2> (*stream)(const Point<2>&)) {
    const Channel channel({Space::axisymmetric, velocity_order}, condition);
    const auto x = interpolate_velocity(channel.disc, stream);
    return channel.convected(x, x);
  };
  EXPECT_NEAR(work(OpeningCondition::total_pressure, downwards), 0, 1e-12);
  EXPECT_NEAR(work(OpeningCondition::total_pressure, upwards), 0, 1e-12);
  EXPECT_NEAR(work(OpeningCondition::static_pressure, downwards), carried, 1e-12);
  EXPECT_NEAR(work(OpeningCondition::static_pressure, upwards), 0, 1e-12);
  EXPECT_NEAR(work(OpeningCondition::traction, downwards), carried, 1e-12);
  EXPECT_NEAR(work(OpeningCondition::traction, upwards), -carried, 1e-12);
}

/// Volume of revolution of a counter-clockwise polygon, pi times the integral of r^2 dz.
double revolved(const std::vector<Point<2>>& outline) {
  double volume = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    volume += pi / 3 * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * (b[1] - a[1]);
  }
  return std::abs(volume);
}

TEST(PumpVolumes, AreThoseOfTheProfileRevolved) {
  const auto profile =
      read_pump_profile(std::string(UNDULA_SOURCE_DIR) + "/data/profiles/wave_pump_profile.toml");
  const PumpMeshSizes sizes{2, 0.25, 0.08, 0.6};
  FsiProblem<2> problem;
  problem.space = Space::axisymmetric;
  problem.fluid = {1.06, 0.035};
  problem.stabilisation = derived_weights(100, 2e-4);
  problem.background = pump_background(profile, sizes);
  for (const auto& name : problem.background.boundary_names)
    problem.boundary[name].kind = BoundaryCondition<2>::Kind::velocity;
  for (const double density : {1.125, 7.85}) {
    SolidBody<2> body;
    body.mesh = problem.solids.empty() ? pump_membrane(profile, sizes) : pump_magnet(profile, sizes);
    body.properties = {density, 1e6, 0.3, 0.0};
    problem.solids.push_back(std::move(body));
  }
  const auto disc = discretise(std::move(problem), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
  const Eigen::VectorXd one = interpolate_velocity(disc, upwards), momentum = operators.mass * one;
  const auto mass_between = [&](int begin, int end) {
    return one.segment(begin, end - begin).dot(momentum.segment(begin, end - begin));
  };
  const double membrane = revolved(membrane_outline(profile.membrane).points),
               magnet = revolved(profile.magnet.points);
  const double fluid = revolved(fluid_outline(profile).points) - membrane - magnet;
  EXPECT_NEAR(mass_between(0, disc.solid_offset[0]), 1.06 * fluid, 1e-11 * fluid);
  EXPECT_NEAR(mass_between(disc.solid_offset[0], disc.solid_offset[1]), 1.125 * membrane, 1e-11 * membrane);
  EXPECT_NEAR(mass_between(disc.solid_offset[1], disc.solid_offset[2]), 7.85 * magnet, 1e-11 * magnet);
}

} // namespace
} // namespace undula::fom
