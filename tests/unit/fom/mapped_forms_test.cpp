// Weak forms on a domain moved by a map: against the same forms on a mesh that was moved itself, conservation
// of uniform flow, of volume and of energy.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "tests/verification/support/channel_problem.hpp"
#include "tests/verification/support/mapped_run.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double pi = std::numbers::pi;

double difference(const SparseMatrix& a, const SparseMatrix& b) {
  const SparseMatrix c = a - b;
  double largest = 0, size = 0;
  for (int row = 0; row < a.outerSize(); ++row) {
    for (SparseMatrix::InnerIterator entry(c, row); entry; ++entry)
      largest = std::max(largest, std::abs(entry.value()));
    for (SparseMatrix::InnerIterator entry(a, row); entry; ++entry)
      size = std::max(size, std::abs(entry.value()));
  }
  return largest / size;
}

class MappedForms : public testing::TestWithParam<Elements> {
protected:
  Operators<2> build(const Discretisation<2>& disc) { return build_operators(disc, MPI_COMM_SELF, timer); }
  PhaseTimer timer;
};
INSTANTIATE_TEST_SUITE_P(Elements, MappedForms, testing::ValuesIn(all_elements),
                         [](const auto& instance) { return instance.param.name(); });

TEST_P(MappedForms, NoDisplacementIsNoMap) {
  auto disc = discretise(channel_with_plate(GetParam()), CutOptions{});
  const auto fixed = build(disc);
  disc.map.displacement.assign(disc.fluid_nodes.dof_point.size(), Point<2>::Zero());
  disc.map.velocity = disc.map.displacement;
  const auto mapped = build(disc);
  EXPECT_LT(difference(fixed.mass, mapped.mass), 1e-13);
  EXPECT_LT(difference(fixed.physical, mapped.physical), 1e-13);
  EXPECT_LT(difference(fixed.stabilisation, mapped.stabilisation), 1e-13);
}

/// Bit for bit, from map to map.
TEST_P(MappedForms, MovingTheOperatorsIsBuildingThemAnew) {
  auto disc = discretise(channel_with_plate(GetParam()), CutOptions{});
  auto moving = build(disc);
  const auto map = nodal_map([](const Point<2>& x, double t) -> Point<2> {
    return 0.1 * t * std::sin(pi * x[0]) * std::sin(pi * x[1] / Sizes::height) * Point<2>(1, -0.5);
  });
  for (const double t : {0.3, 0.7, 1.0}) {
    disc.map.displacement = disc.map.velocity = map(disc, t);
    move_operators(disc, moving, timer);
    const auto fresh = build(disc);
    for (const auto member : {&Operators<2>::mass, &Operators<2>::physical, &Operators<2>::stabilisation})
      EXPECT_EQ(difference(fresh.*member, moving.*member), 0);
    const auto x =
        interpolate_velocity(disc, [](const Point<2>& at) { return Point<2>(at[1], at[0] * at[1]); });
    double sums[2] = {0, 0};
    visit_convection(disc, fresh, x, [&](int i, int j, double value) { sums[0] += x[i] * value * (j + 1); });
    visit_convection(disc, moving, x, [&](int i, int j, double value) { sums[1] += x[i] * value * (j + 1); });
    EXPECT_EQ(sums[0], sums[1]);
  }
}

/// The same coefficients on a mesh moved before it is cut. `scale` must keep the axis. Under a similarity the
/// penalties agree too.
TEST_P(MappedForms, AreThoseOfTheMovedMesh) {
  for (const Point<2>& scale : {Point<2>(0.7, 0.7), Point<2>(1.3, 0.6)}) {
    auto disc = discretise(channel_with_plate(GetParam()), CutOptions{});
    disc.map.displacement = nodal_map([&](const Point<2>& x, double) -> Point<2> {
      return (scale.array() - 1).matrix().cwiseProduct(x);
    })(disc, 0);
    disc.map.velocity.assign(disc.map.displacement.size(), Point<2>::Zero());
    auto problem = channel_with_plate(GetParam());
    for (auto* mesh : {&problem.background, &problem.solids[0].mesh})
      for (auto& x : mesh->points) x = x.cwiseProduct(scale);
    const auto moved = discretise(std::move(problem), CutOptions{});
    ASSERT_EQ(disc.unknowns(), moved.unknowns());
    const auto a = build(disc), b = build(moved);
    const int fluid = disc.fluid_unknowns();
    const SparseMatrix mass_a = a.mass.topLeftCorner(fluid, fluid),
                       mass_b = b.mass.topLeftCorner(fluid, fluid);
    EXPECT_LT(difference(mass_b, mass_a), 1e-12);
    // 1/r is integrated to the accuracy of the rule, and the moved mesh may divide its cut elements
    // otherwise.
    EXPECT_LT(
        difference(b.physical, a.physical),
        GetParam().space == Space::plane ? 1e-12 : 1e-8); // with the interface, rows and columns of the solid
    if (scale[0] == scale[1]) {
      EXPECT_LT(difference(b.stabilisation, a.stabilisation), 1e-12);
    }
    EXPECT_NEAR(smallest_volume_ratio(disc),
                scale.prod() * (GetParam().space == Space::axisymmetric ? scale[0] : 1.0), 1e-12);
  }
}

/// Everything moves along with the same velocity, while the nodes in between move at random: nothing happens.
TEST_P(MappedForms, UniformFlowStaysUniform) {
  const Point<2> stream = GetParam().space == Space::plane ? Point<2>(0.7, -1.1) : Point<2>(0, -1.1);
  for (const auto scheme : {TimeScheme::bdf1, TimeScheme::bdf2}) {
    auto problem = channel_with_plate(GetParam());
    for (auto& [name, condition] : problem.boundary)
      if (GetParam().space == Space::plane || name != "axis") {
        condition.kind = BoundaryCondition<2>::Kind::velocity;
        condition.velocity = [&](const Point<2>&, double) { return stream; };
      }
    problem.pin_pressure = true;
    problem.solids[0].imposed = [](const Point<2>&) { return true; };
    problem.solids[0].imposed_displacement = [&](const Point<2>&, double t) -> Point<2> {
      return t * stream;
    };
    auto disc = discretise(std::move(problem), CutOptions{});
    std::vector<char> along(disc.fluid_nodes.dof_point.size(), 0);
    for (std::size_t p = 0; p < disc.cut.parts.size(); ++p)
      if (disc.cut.parts[p].cut)
        for (const int node : disc.fluid_nodes.part_dofs[p]) along[node] = 1;
    std::vector<Point<2>> shift(along.size());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(-0.03, 0.03);
    for (auto& s : shift) s = {value(random), value(random)};
    int free = 0;
    const MapOfTime map = [&](const Discretisation<2>& at, double t) {
      std::vector<Point<2>> displacement;
      for (std::size_t node = 0; node < along.size(); ++node) {
        const auto& x = at.cut.mesh.points[at.fluid_nodes.dof_point[node]];
        const bool inside =
            x[0] > 1e-9 && x[0] < Sizes::radius - 1e-9 && x[1] > 1e-9 && x[1] < Sizes::height - 1e-9;
        const bool moves = inside && !along[node];
        free += moves;
        displacement.push_back(t * stream + (moves ? std::sin(300 * t) : 0.0) * shift[node]);
      }
      return displacement;
    };
    State state = initial_state(disc);
    for (auto& level : state.x) level = interpolate_velocity(disc, [&](const Point<2>&) { return stream; });
    const Eigen::VectorXd uniform = state.x[0];
    state = march_mapped(disc, map, scheme, 1e-3, 5, std::move(state));
    EXPECT_GT(free, 100);
    EXPECT_LT(smallest_volume_ratio(disc), 0.8);
    const int fluid = disc.fluid_unknowns();
    EXPECT_LT((state.x[0] - uniform).head(fluid).lpNorm<Eigen::Infinity>(), 1e-9);
  }
}

/// d/dt of the kinetic energy against what the scheme makes of it, (M T x, x) + (C(x) x, x), for given smooth
/// motions of nodes and velocities: the two differ by the order of the scheme.
TEST_P(MappedForms, EnergyIsKeptToTheOrderOfTheScheme) {
  auto disc = discretise(channel_with_plate(GetParam()), CutOptions{});
  const auto map = nodal_map([](const Point<2>& x, double t) -> Point<2> {
    const double bump = 0.05 * std::sin(pi * x[0] / Sizes::radius) * std::sin(pi * x[1] / Sizes::height);
    return bump * Point<2>(std::sin(2 * t), std::cos(3 * t));
  });
  const auto a = interpolate_velocity(disc, [](const Point<2>&x) { return Point<2>(x[0] * x[1], 1 + x[0]); }),
             b = interpolate_velocity(disc, [](const Point<2>&x) { return Point<2>(-x[0], x[1] * x[1]); });
  const int fluid = disc.fluid_unknowns();
  const auto velocity = [&](double t) -> Eigen::VectorXd {
    Eigen::VectorXd x = std::cos(t) * a + std::sin(2 * t) * b;
    x.tail(x.size() - fluid).setZero();
    return x;
  };
  const auto energy = [&](double t) {
    disc.map.displacement = map(disc, t);
    disc.map.velocity.clear();
    const auto x = velocity(t);
    return 0.5 * x.dot(build(disc).mass * x);
  };
  const double t = 0.4;
  const double exact =
      (8 * (energy(t + 1e-3) - energy(t - 1e-3)) - energy(t + 2e-3) + energy(t - 2e-3)) / 12e-3;
  for (const auto& [scheme, order] : {std::pair(TimeScheme::bdf1, 1.0), std::pair(TimeScheme::bdf2, 2.0)}) {
    std::vector<double> errors;
    for (const int steps : {16, 32}) {
      const double dt = t / steps;
      set_map(disc, map, scheme, steps, dt);
      const auto operators = build(disc);
      const auto alpha = bdf_coefficients(scheme, steps);
      const Eigen::VectorXd x = velocity(t), rate = (alpha[0] * x + alpha[1] * velocity(t - dt) +
                                                     alpha[2] * velocity(t - 2 * dt)) /
                                                    dt;
      double power = x.dot(operators.mass * rate);
      visit_convection(disc, operators, x, [&](int i, int j, double value) { power += x[i] * value * x[j]; });
      errors.push_back(std::abs(power - exact));
    }
    std::printf("BDF%.0f: power %.6g, errors %.2e %.2e\n", order, exact, errors[0], errors[1]);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.2);
  }
}

/// A piston as wide as the channel that closes the space before it to a film: uniform flow, linear pressure.
/// In Stokes flow the piston swings; with convection, which takes its velocity from the steps before, it
/// keeps its speed.
TEST_P(MappedForms, APistonPushesAUniformFlow) {
  const double height = 1, low = 0.437, high = 0.551, rate = 3;
  const std::array cases = {std::pair(TimeScheme::bdf1, FlowModel::stokes),
                            std::pair(TimeScheme::bdf2, FlowModel::stokes),
                            std::pair(TimeScheme::bdf1, FlowModel::navier_stokes),
                            std::pair(TimeScheme::bdf2, FlowModel::navier_stokes)};
  for (const auto& [scheme, flow] : cases) {
    SCOPED_TRACE(flow == FlowModel::stokes ? "Stokes" : "Navier-Stokes");
    FsiProblem<2> problem;
    problem.space = GetParam().space;
    problem.velocity_order = GetParam().velocity_order;
    problem.flow = flow;
    problem.fluid = {1.0, 0.05};
    problem.stabilisation = derived_weights(1.0, 0.1);
    problem.background =
        tensor_mesh(spaced(0, 0.5, 5), spaced(0, height, 16), {"axis", "wall", "below", "above"});
    using Kind = BoundaryCondition<2>::Kind;
    problem.boundary["axis"].kind = problem.boundary["wall"].kind = Kind::symmetry;
    for (const char* name : {"below", "above"}) {
      problem.boundary[name].kind = Kind::opening;
      problem.boundary[name].opening = OpeningCondition::traction;
    }
    SolidBody<2> piston;
    piston.mesh = box({0, low}, {0.5, high}, 4, 2);
    piston.properties = {1, 1e6, 0.3, 0};
    piston.imposed = [](const Point<2>&) { return true; };
    const double stroke = 0.97 * (height - high);
    const double whole = pi / 2 / rate; // ends with the film
    const bool swings = flow == FlowModel::stokes;
    const auto place = [=](double t) { return stroke * (swings ? std::sin(rate * t) : t / whole); };
    piston.imposed_displacement = [=](const Point<2>&, double t) { return Point<2>(0.0, place(t)); };
    problem.solids.push_back(std::move(piston));
    auto disc = discretise(std::move(problem), CutOptions{});
    const auto extension = prepare_extension(disc);
    const int steps = 12;
    const double dt = whole / steps;
    std::vector<double> speed(2, swings ? 0.0 : stroke / whole);
    State start = initial_state(disc);
    start.x[0] = interpolate_velocity(disc, [&](const Point<2>&) { return Point<2>(0, speed[0]); });
    march_mapped(disc, extended_map(extension), scheme, dt, steps, std::move(start),
                 [&](const State& state, const Operators<2>& operators) {
                   const auto alpha = bdf_coefficients(scheme, state.step);
                   const double v = (alpha[0] * place(state.time) + alpha[1] * place(state.time - dt) +
                                     alpha[2] * place(state.time - 2 * dt)) /
                                    dt;
                   const double acceleration =
                       (alpha[0] * v + alpha[1] * speed[0] + alpha[2] * speed[1]) / dt;
                   double velocity_error = 0, pressure_error = 0;
                   for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node) {
                     const Point<2> rest = disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]];
                     const double y = (rest + disc.map.displacement[node])[1];
                     const auto x = state.x[0].segment<3>(disc.velocity_unknown(static_cast<int>(node), 0));
                     velocity_error = std::max(velocity_error, (x.head<2>() - Point<2>(0, v)).norm());
                     const double from = rest[1] > 0.5 * (low + high) ? height : 0.0;
                     // Nodes under the skin carry the extension of the pressure on their side.
                     if (rest[1] < low || rest[1] > high)
                       pressure_error = std::max(pressure_error, std::abs(x[2] + acceleration * (y - from)));
                   }
                   EXPECT_LT(velocity_error, 1e-8 * rate) << "step " << state.step;
                   EXPECT_LT(pressure_error, 1e-7 * rate * rate) << "step " << state.step;
                   const double area = GetParam().space == Space::axisymmetric ? pi * 0.25 : 0.5;
                   EXPECT_NEAR(operators.openings.at("above").dot(state.x[0]), area * v, 1e-8 * area * rate);
                   EXPECT_NEAR(operators.openings.at("below").dot(state.x[0]), -area * v, 1e-8 * area * rate);
                   speed = {v, speed[0]};
                 });
    EXPECT_NEAR(smallest_volume_ratio(disc), 0.03, 1e-3);
  }
}

} // namespace
} // namespace undula::fom
