// Derivatives of a thin-gap step against finite differences of its equations.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <random>

#include "fom/thin_gap/contact_law.hpp"
#include "fom/thin_gap/step_equations.hpp"

namespace undula::fom {
namespace {

struct JacobianCase {
  const char* name;
  FlowModel flow;
  SolidModel solid;
  GapFriction friction;
  bool contact;
  Drive drive = Drive::stroke;
};

class ThinGapJacobian : public testing::TestWithParam<JacobianCase> {};

ThinGapLayout small_layout() {
  ThinGapLayout layout;
  constexpr int cells = 8;
  for (int i = 0; i <= cells; ++i) {
    layout.radius.push_back(0.5 + 0.2 * i + 0.01 * i * i);
    layout.thickness.push_back(0.06 + 0.005 * i);
    if (i <= 6) layout.upper_height.push_back(0.11 - 0.003 * i);
    layout.lower_height.push_back(i < 1 ? 0.5 : 0.12 - 0.002 * i);
  }
  layout.clamp = 5;
  layout.channel = 6;
  layout.lip = 1;
  layout.holder_area = 3;
  layout.inlet = {1.5, 3.0, 1.1};
  layout.rim = {0.4, 30.0, 0.5};
  layout.outlet = {1.2, 2.0, 0.9};
  return layout;
}

/// Every entry of the matrix is the central difference of the residual, in and out of contact, and outside of
/// the band there is nothing to differentiate.
TEST_P(ThinGapJacobian, IsTheDerivativeOfTheResidual) {
  const auto& param = GetParam();
  const auto layout = small_layout();
  Scene scene;
  scene.space = Space::thin_gap;
  scene.flow = param.flow;
  scene.solid_model = param.solid;
  scene.fluid = {1.0, 0.035};
  scene.membrane = {1.125, 1.686e7, 0.49, 1e-4};
  scene.operating_point = {120, 0.053, 6e4, 1.0};
  scene.operating_point.drive = param.drive;
  scene.operating_point.voltage = 40;
  scene.actuator = {4e4, 10, 2e7, 1e3, 1.0, 0.01, 5e7};
  scene.time.steps_per_period = 72;
  scene.time.ramp_periods = 0;
  scene.outlet = OpeningCondition::static_pressure;
  scene.thin_gap.film_thickness = 0.02;
  scene.thin_gap.contact_stiffness = 1e7;
  scene.thin_gap.throat_recovery = 0.3;
  scene.thin_gap.exit_recovery = 0.2;
  scene.thin_gap.entry_loss = 0.5;
  scene.thin_gap.momentum_factor = 1.2;
  scene.thin_gap.friction = param.friction;

  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  State state;
  state.step = 5;
  for (int level : {0, 1}) {
    auto& x = state.x[level];
    auto& d = state.d[level];
    x.setZero(at.size());
    d.setZero(at.displacements());
    x[at.tip_pressure] = 2e4 * unit(random);
    for (int node = 0; node <= at.nodes; ++node) {
      x[at.upper_flow(node)] = 60 * unit(random);
      x[at.lower_flow(node)] = 60 * unit(random);
      if (node == at.nodes) break;
      x[at.upper_pressure(node)] = 2e4 * unit(random);
      x[at.lower_pressure(node)] = 2e4 * unit(random);
      x[at.deflection_rate(node)] = 20 * unit(random);
      x[at.rotation_rate(node)] = 20 * unit(random);
      x[at.radial_rate(node)] = 2 * unit(random);
      // In contact: alternately on either side, some beyond the wall.
      const double side = node % 2 == 0 ? 1 : -1;
      d[at.deflection(node)] = param.contact ? side * (0.1 + 0.02 * unit(random)) : 0.04 * unit(random);
      d[at.rotation(node)] = 0.1 * unit(random);
      d[at.radial(node)] = 0.01 * unit(random);
    }
  }
  const ThinGapStep step = next_step(layout, scene, state);
  Eigen::VectorXd x = 2 * state.x[0] - state.x[1];
  if (param.contact) { // the state has contact at the end of the step, not only before
    int touching = 0;
    const Eigen::VectorXd d = displacements(step, x);
    for (int node = 0; node < layout.channel; ++node)
      touching += contact_pressure(scene.thin_gap, upper_height(layout, node, d[at.deflection(node)])) > 0 ||
                  contact_pressure(scene.thin_gap, lower_height(layout, node, d[at.deflection(node)])) > 0;
    ASSERT_GE(touching, 2);
  }
  BandMatrix matrix(at.size(), ThinGapUnknowns::reach);
  Eigen::VectorXd residual, ahead, behind, without;
  HolderEquation holder, moved_holder;
  assemble(step, x, residual, &matrix, holder);
  assemble(step, x, without, nullptr, moved_holder);
  ASSERT_LT((residual - without).norm(), 1e-13 * residual.norm());
  Eigen::VectorXd holder_row = Eigen::VectorXd::Zero(at.size());
  Eigen::MatrixXd analytic = Eigen::MatrixXd::Zero(at.size(), at.size()), numerical = analytic;
  for (int column = 0; column < at.size(); ++column) {
    const double h = 1e-5 * std::max(1.0, std::abs(x[column]));
    Eigen::VectorXd moved = x;
    moved[column] += h;
    assemble(step, moved, ahead, nullptr, moved_holder);
    holder_row[column] = moved_holder.residual / (2 * h);
    moved[column] = x[column] - h;
    assemble(step, moved, behind, nullptr, moved_holder);
    holder_row[column] -= moved_holder.residual / (2 * h);
    numerical.col(column) = (ahead - behind) / (2 * h);
    for (int row = std::max(0, column - ThinGapUnknowns::reach);
         row <= std::min(at.size() - 1, column + ThinGapUnknowns::reach); ++row)
      analytic(row, column) = matrix(row, column);
  }
  if (param.drive == Drive::voltage) // the matrix is that for a given velocity of the holder
    for (int node = layout.clamp; node < at.nodes; ++node)
      numerical(at.deflection_rate(node), at.deflection_rate(at.nodes - 1)) += 1;
  // Measured against the largest entry of the row: rounding of the residual is of that size.
  double worst = 0;
  for (int row = 0; row < at.size(); ++row) {
    const double size = analytic.row(row).lpNorm<Eigen::Infinity>();
    ASSERT_GT(size, 0) << "row " << row;
    for (int column = 0; column < at.size(); ++column) {
      const double error = std::abs(analytic(row, column) - numerical(row, column)) / size;
      worst = std::max(worst, error);
      EXPECT_LT(error, 1e-5) << "row " << row << ", column " << column << ": " << analytic(row, column)
                             << " and " << numerical(row, column);
    }
  }
  if (param.drive == Drive::voltage) {
    // The equations of the holder's nodes read its velocity from the last of them, its own equation as well.
    const int last = at.deflection_rate(at.nodes - 1);
    Eigen::VectorXd row = holder.row;
    row[last] += holder.by_velocity;
    EXPECT_LT((row - holder_row).lpNorm<Eigen::Infinity>(), 1e-5 * row.lpNorm<Eigen::Infinity>());
    EXPECT_GT(row.head(last - ThinGapUnknowns::reach).lpNorm<Eigen::Infinity>(),
              0); // beyond the reach of the band
  }
  std::printf("%s: largest difference %.1e of the row's largest entry\n", param.name, worst);
}

INSTANTIATE_TEST_SUITE_P(States, ThinGapJacobian,
                         testing::Values(JacobianCase{"Open", FlowModel::navier_stokes,
                                                      SolidModel::von_karman, GapFriction::poiseuille, false},
                                         JacobianCase{"InContact", FlowModel::navier_stokes,
                                                      SolidModel::von_karman, GapFriction::poiseuille, true},
                                         JacobianCase{"Oscillatory", FlowModel::navier_stokes,
                                                      SolidModel::linear, GapFriction::oscillatory, false},
                                         JacobianCase{"ByVoltage", FlowModel::navier_stokes,
                                                      SolidModel::von_karman, GapFriction::poiseuille, true,
                                                      Drive::voltage},
                                         JacobianCase{"Stokes", FlowModel::stokes, SolidModel::linear,
                                                      GapFriction::poiseuille, true}),
                         [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace undula::fom
