#include "training/reduction/projection.hpp"

#include <gtest/gtest.h>

#include <random>

#include "coarse_pump.hpp"
#include "fom/levels/extrapolation.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "rom/base/units.hpp"
#include "rom/fixed_domain/periodic.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/reduction/judge.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

/// Random columns on the free unknowns of each field.
Bases random_bases(const Discretisation<2>& disc, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto columns = [&](const std::vector<int>& unknowns, int count) {
    Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(disc.unknowns(), count);
    for (int j = 0; j < count; ++j)
      for (const int unknown : unknowns)
        if (!disc.is_constrained[static_cast<std::size_t>(unknown)]) modes(unknown, j) = normal(random);
    return modes;
  };
  Bases bases;
  bases.velocity = columns(velocity_unknowns(disc), 4);
  bases.pressure = columns(pressure_unknowns(disc), 3);
  bases.displacement = columns(displacement_unknowns(disc), 2);
  bases.supremizers = 3;
  return bases;
}

TEST(Projection, ReducedResidualIsTheProjectedResidual) {
  PhaseTimer timer;
  const auto prepared = prepare_scene(coarse_pump(), MPI_COMM_SELF, timer);
  const auto& full = prepared->operators;
  const auto bases = random_bases(prepared->disc, 1);
  const auto reduced = project(*prepared, bases);

  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto vector = [&](Eigen::Index size) {
    return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); }));
  };
  const Eigen::VectorXd y = vector(9), rate = vector(9), a_d = vector(2),
                        b = 1e11 *
                            vector(4); // large enough for convection to matter beside the stiffness of noise
  const double imposed_rate = 0.7, imposed_velocity = -1.3, imposed_displacement = 0.4, head = 2.1;

  Eigen::MatrixXd basis(prepared->disc.unknowns(), 9);
  basis << bases.velocity, bases.pressure, bases.displacement;
  const Eigen::VectorXd lifting = imposed_lifting(prepared->disc);
  const Eigen::VectorXd x = basis * y + imposed_velocity * lifting,
                        dx = basis * rate + imposed_rate * lifting;
  const Eigen::VectorXd d = bases.displacement * a_d + imposed_displacement * lifting;
  Eigen::VectorXd residual = full.mass * dx + full.physical * x + full.stabilisation * x + full.damping * x +
                             full.stiffness * d + head * full.openings.at(outlet_name);
  const Eigen::VectorXd convecting = bases.velocity * b;
  visit_convection(prepared->disc, full, convecting,
                   [&](int row, int column, double value) { residual[row] += value * x[column]; });
  const Eigen::VectorXd expected = basis.transpose() * residual;

  Eigen::VectorXd got = reduced.mass * rate + reduced.linear * y + reduced.imposed_mass * imposed_rate +
                        reduced.imposed_linear * imposed_velocity +
                        reduced.imposed_stiffness * imposed_displacement + reduced.head * head;
  got.tail(2) += reduced.stiffness * a_d;
  for (int k = 0; k < 4; ++k)
    got.head(4) += b[k] * (reduced.convection[static_cast<std::size_t>(k)] * y.head(4));
  EXPECT_LT((got - expected).norm(), 1e-11 * expected.norm());
  // The test would say nothing about convection if it were negligible here.
  Eigen::VectorXd convection = Eigen::VectorXd::Zero(4);
  for (int k = 0; k < 4; ++k)
    convection += b[k] * (reduced.convection[static_cast<std::size_t>(k)] * y.head(4));
  EXPECT_GT(convection.norm(), 1e-2 * expected.norm());
  // Skew: b-independent zero of y.C(b)y.
  EXPECT_LT(std::abs(y.head(4).dot(convection)), 1e-10 * y.head(4).norm() * convection.norm());
}

TEST(Projection, ModelOfOneRunReproducesIt) {
  auto scene = coarse_pump({"operating_point.stroke_mm=0.3", "operating_point.head_mmHg=10",
                            "time.periods=30", "training.periodic_tolerance=1e-5"});
  PhaseTimer timer;
  FiniteElementLevel level(scene, MPI_COMM_SELF, timer);
  const std::vector<RunRecord> runs = {record_run(level, scene)};
  const PreparedScene& prepared = level.prepared();
  ASSERT_EQ(runs[0].state, RunState::periodic) << runs[0].reason;
  // Time levels between snapshots are in the basis too: every step is a snapshot.
  scene.training.energy_tolerance = 1e-12;
  const auto bases = build_bases(prepared, scene, runs);
  const auto reduced = project(prepared, bases);
  const auto run = project_run(prepared, scene, bases, runs[0], true);
  const auto errors =
      judge_run(reduced, reduced.velocity_modes - reduced.supremizer_modes, reduced.pressure_modes,
                reduced.displacement_modes, scene.time.steps_per_period, run);
  ASSERT_TRUE(errors.converged);
  EXPECT_LT(errors.velocity, 2e-3);
  EXPECT_LT(errors.envelope, 2e-3);
  EXPECT_LT(std::abs(errors.flow - run.flow), 2e-3 * std::abs(run.flow));
}

TEST(PeriodicRun, ExtrapolationFindsTheLimitOfALinearSequence) {
  // z_{k+1} = A z_k + c with two modes: three differences determine the limit exactly.
  Eigen::Matrix2d map;
  map << 0.9, 0.2, 0.0, -0.5;
  const Eigen::Vector2d constant(1.0, 2.0);
  const Eigen::Vector2d limit = (Eigen::Matrix2d::Identity() - map).inverse() * constant;
  std::vector<Eigen::Vector2d> states = {Eigen::Vector2d::Zero()};
  for (int k = 0; k < 3; ++k) states.push_back(map * states.back() + constant);
  Eigen::MatrixXd differences(2, 3);
  for (int k = 0; k < 3; ++k)
    differences.col(k) = states[static_cast<std::size_t>(k) + 1] - states[static_cast<std::size_t>(k)];
  const auto weights = extrapolation_weights(differences);
  EXPECT_NEAR(weights.sum(), 1.0, 1e-12);
  Eigen::Vector2d found = Eigen::Vector2d::Zero();
  for (int k = 0; k < 3; ++k) found += weights[k] * states[static_cast<std::size_t>(k) + 1];
  EXPECT_LT((found - limit).norm(), 1e-10 * limit.norm());
}

TEST(PeriodicRun, ExtrapolatedStateIsTheLimitOfTheMarch) {
  // Ten times the viscosity, so that the slow modes of the channels die out within a march of 30 periods.
  const std::vector<std::string> point = {"operating_point.stroke_mm=0.2", "operating_point.head_mmHg=5",
                                          "training.periodic_tolerance=1e-6", "time.periods=60",
                                          "fluid.viscosity_poise=0.35"};
  const auto scene = coarse_pump(point);
  PhaseTimer timer;
  FiniteElementLevel level(scene, MPI_COMM_SELF, timer);
  State settled = level.initial_state();
  const auto record = march_until_periodic(level, scene, settled);
  ASSERT_EQ(record.state, RunState::periodic) << record.reason;
  const std::size_t periods = record.cycles.periods.size();
  EXPECT_LT(periods, 25u);
  const double flow = record.cycles.mean[(periods - 1) * record.cycles.columns.size()];

  // The plain march creeps towards it, from one side: a value that has merely stopped early would be passed.
  State state = level.initial_state();
  auto longer = scene;
  longer.time.periods = 32;
  std::vector<double> means(33, 0.0);
  march(level, longer, state, timer, [&](const State& now, const Observation& seen) {
    const int period = (now.step + scene.time.steps_per_period - 1) / scene.time.steps_per_period;
    means[static_cast<std::size_t>(period)] +=
        units::flow_to_l_per_min(seen.outflow) / scene.time.steps_per_period;
  });
  const double early = means[8] - flow, late = means[32] - flow;
  EXPECT_GT(early * late, 0.0) << means[8] << " " << means[32] << " " << flow;
  EXPECT_LT(std::abs(late), 0.7 * std::abs(early));
  EXPECT_LT(std::abs(late), 0.05 * std::abs(flow));
}

} // namespace
} // namespace undula::training
