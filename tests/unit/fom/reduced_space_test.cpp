// Unknowns in a subspace, sums over weighted parts and cells.
#include <gtest/gtest.h>

#include "fom/coupling/moving_stepper.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
constexpr double dt = 1.0 / (ChannelSizes::frequency * 64);

/// A plate under a nonlinear law, driven by a voltage, across a channel with quadratic velocities.
struct Channel {
  Channel() {
    auto problem = channel_with_plate(Space::axisymmetric, 2);
    problem.solids[0].model = SolidModel::neo_hookean;
    problem.holder.emplace();
    problem.holder->actuator.force_per_volt = 100; // dyn/V
    problem.holder->actuator.moving_mass = 0.3;
    problem.holder->actuator.stiffness = 3e5;
    problem.holder->actuator.damping = 50;
    problem.holder->voltage = [](double t) {
      return 60 * std::sin(2 * std::numbers::pi * ChannelSizes::frequency * t);
    };
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, PETSC_COMM_SELF, timer);
  }

  State after(int steps) {
    SteppingSettings settings;
    settings.convection.tolerance = 1e-6;
    State state = initial_state(disc);
    MovingStepper<2> stepper(disc, operators, Coupling::mapped, settings, ContactSettings{}, dt, timer,
                             state);
    for (int step = 0; step < steps; ++step) stepper.advance(state);
    return state;
  }

  /// One mode per unknown that is free, one for the holder.
  Eigen::MatrixXd all_modes() const {
    std::vector<int> free;
    for (int unknown = 0; unknown < disc.unknowns(); ++unknown)
      if (!disc.is_constrained[unknown]) free.push_back(unknown);
    Eigen::MatrixXd basis =
        Eigen::MatrixXd::Zero(disc.unknowns(), static_cast<Eigen::Index>(free.size()) + 1);
    for (std::size_t k = 0; k < free.size(); ++k) basis(free[k], static_cast<Eigen::Index>(k)) = 1;
    for (const int unknown : disc.joined) basis(unknown, static_cast<Eigen::Index>(free.size())) = 1;
    return basis;
  }

  std::size_t cells() const { return disc.solid_spaces[0].cell_nodes.size(); }

  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
};

double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).norm() / b.norm(); }

TEST(ReducedSpace, WithAllModesIsTheFullOrder) {
  constexpr int steps = 3;
  Channel full, reduced;
  const State expected = full.after(steps);
  auto space = std::make_shared<ReducedSpace>();
  space->basis = reduced.all_modes();
  reduced.disc.reduced = space;
  const State state = reduced.after(steps);
  EXPECT_LT(distance(state.x[0], expected.x[0]), 1e-6);
  EXPECT_LT(distance(state.d[0], expected.d[0]), 1e-6);
  EXPECT_GT(std::abs(state.d[0][reduced.disc.joined.front()]), 1e-6);
}

TEST(ReducedSpace, ModesThatMissTheFlowGiveAnotherAnswer) {
  constexpr int steps = 3;
  Channel full, reduced;
  const State expected = full.after(steps);
  auto space = std::make_shared<ReducedSpace>();
  const Eigen::MatrixXd all = reduced.all_modes();
  space->basis = all.rightCols(all.cols() - all.cols() / 10);
  reduced.disc.reduced = space;
  EXPECT_GT(distance(reduced.after(steps).x[0], expected.x[0]), 1e-3);
}

TEST(ReducedSpace, AnswerInTheSpanOfAFewModesIsFound) {
  // Snapshots of the run itself, velocities and pressures apart, with the velocities that the pressures
  // drive.
  constexpr int steps = 6;
  Channel full, reduced;
  std::vector<Eigen::VectorXd> seen;
  for (int step = 1; step <= steps; ++step) seen.push_back(Channel().after(step).x[0]);
  const State expected = full.after(steps);
  std::vector<Eigen::VectorXd> modes;
  for (const auto& x : seen) {
    Eigen::VectorXd pressure = Eigen::VectorXd::Zero(x.size());
    for (int node = 0; node < full.disc.vertex_nodes(); ++node)
      pressure[full.disc.pressure_unknown(node)] = x[full.disc.pressure_unknown(node)];
    modes.push_back(x - pressure);
    modes.push_back(pressure);
    Eigen::VectorXd driven = full.operators.physical * pressure;
    for (int node = 0; node < full.disc.vertex_nodes(); ++node) driven[full.disc.pressure_unknown(node)] = 0;
    driven.tail(full.disc.solid_unknowns()).setZero();
    constrain_rows(full.disc, driven);
    modes.push_back(driven);
  }
  auto space = std::make_shared<ReducedSpace>();
  space->basis.resize(full.disc.unknowns(), static_cast<Eigen::Index>(modes.size()));
  for (std::size_t k = 0; k < modes.size(); ++k)
    space->basis.col(static_cast<Eigen::Index>(k)) = modes[k] / modes[k].norm();
  reduced.disc.reduced = space;
  const State state = reduced.after(steps);
  EXPECT_LT(distance(state.d[0], expected.d[0]), 0.02);
  EXPECT_LT(
      distance(state.x[0].tail(full.disc.solid_unknowns()), expected.x[0].tail(full.disc.solid_unknowns())),
      0.02);
}

TEST(ReducedSpace, WeightsMultiplyWhatPartsAndCellsExert) {
  Channel channel;
  auto& disc = channel.disc;
  auto space = std::make_shared<ReducedSpace>();
  space->part_weights.assign(disc.cut.parts.size(), 2.0);
  space->cell_weights.assign(channel.cells(), 3.0);
  disc.reduced = space;
  const auto weighted = build_operators(disc, PETSC_COMM_SELF, channel.timer);
  const auto& full = channel.operators;
  EXPECT_LT((weighted.physical - 2 * full.physical).norm(), 1e-12 * full.physical.norm());
  EXPECT_LT((weighted.stabilisation - 2 * full.stabilisation).norm(), 1e-12 * full.stabilisation.norm());
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(disc.unknowns());
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown)
    moved[unknown] = 1e-3 * std::sin(0.1 * unknown);
  const SolidRates rates{1, 1};
  const auto with = solid_response(disc, weighted.nonlinear_cells, moved, moved, rates, false);
  disc.reduced = nullptr;
  const auto without = solid_response(disc, full.nonlinear_cells, moved, moved, rates, false);
  EXPECT_GT(without.elastic.norm(), 0);
  EXPECT_LT((with.elastic - 3 * without.elastic).norm(), 1e-12 * without.elastic.norm());
  EXPECT_LT((with.viscous - 3 * without.viscous).norm(), 1e-12 * without.viscous.norm());
}

TEST(ReducedSpace, OperatorsOfTwoHalvesAddUp) {
  Channel channel;
  auto& disc = channel.disc;
  SparseMatrix physical, stabilisation, mass;
  for (const int half : {0, 1}) {
    auto space = std::make_shared<ReducedSpace>();
    space->part_weights.assign(disc.cut.parts.size(), 0.0);
    for (std::size_t part = 0; part < disc.cut.parts.size(); ++part)
      space->part_weights[part] = static_cast<int>(part % 2) == half ? 1.0 : 0.0;
    disc.reduced = space;
    auto operators = build_operators(disc, PETSC_COMM_SELF, channel.timer);
    EXPECT_LT(operators.physical.nonZeros(), channel.operators.physical.nonZeros());
    const auto add = [&](SparseMatrix& sum, const SparseMatrix& one) {
      sum = half == 0 ? one : SparseMatrix(sum + one);
    };
    add(physical, operators.physical);
    add(stabilisation, operators.stabilisation);
    operators.solid_mass.clear();
    move_operators(disc, operators, channel.timer);
    add(mass, operators.mass);
  }
  const auto& full = channel.operators;
  EXPECT_LT((physical - full.physical).norm(), 1e-12 * full.physical.norm());
  EXPECT_LT((stabilisation - full.stabilisation).norm(), 1e-12 * full.stabilisation.norm());
  const SparseMatrix solids = compress(disc.unknowns(), full.solid_mass);
  EXPECT_LT((mass + solids - full.mass).norm(), 1e-12 * full.mass.norm());
}

} // namespace
} // namespace undula::fom
