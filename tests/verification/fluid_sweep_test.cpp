// Errors and conditioning stay bounded however the skin of a solid lies in the elements; without ghost
// penalty they do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>

#include "fom/problem/default_weights.hpp"
#include "tests/verification/support/condition_number.hpp"
#include "tests/verification/support/flow_gallery.hpp"
#include "tests/verification/support/steady_flow.hpp"

namespace undula::verification {
namespace {

/// Diagonal of the system on an uncut mesh of size h up to a factor: mu for velocities, h^2 / mu for
/// pressures.
Eigen::VectorXd uncut_scale(const Discretisation<2>& disc, double h) {
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(disc.unknowns(), disc.problem.fluid.viscosity);
  for (int u = 2; u < disc.fluid_unknowns(); u += 3) scale[u] = h * h / disc.problem.fluid.viscosity;
  return scale;
}

/// A box whose four sides start on lines of an n x n mesh, pushed by `offset` cells along x and half of it
/// along y.
struct SweptBox {
  int n;
  TurnedBox box;
  FsiProblem<2> problem;
  ManufacturedFlow flow;

  SweptBox(int cells, double offset, const StabilisationWeights& weights) : n(cells) {
    const double h = 1.0 / n;
    box = {Point<2>(0.5 + offset * h, 0.5 - 0.5 * offset * h), n / 6 * h, n / 8 * h, 0};
    flow = plane_flow_around(box);
    problem = manufactured_problem(flow, tensor_mesh(spaced(0, 1, n), spaced(0, 1, n)),
                                   turned_box(box.centre, box.half_x, box.half_y, 0, 3, 2), weights);
  }
};

double condition_at(double offset, const StabilisationWeights& weights) {
  const SweptBox swept(10, offset, weights);
  PhaseTimer timer;
  const auto disc = discretise<2>(swept.problem, fine_quadrature());
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
  return condition_number(disc, operators, uncut_scale(disc, 1.0 / swept.n));
}

FlowErrors errors_at(double offset, const StabilisationWeights& weights) {
  const SweptBox swept(24, offset, weights);
  return solve_manufactured(swept.flow, swept.problem);
}

/// Cells; from the tiniest slivers of fluid to whole elements.
const std::vector<double> offsets{0,    1e-10, 1e-8, 1e-7, 1e-6,     1e-5,     1e-4,     1e-3,
                                  1e-2, 0.03,  0.1,  0.2,  0.3,      0.4,      0.5,      0.6,
                                  0.7,  0.8,   0.9,  0.99, 1 - 1e-4, 1 - 1e-6, 1 - 1e-8, 1};

struct Spread {
  double median, worst; ///< worst: largest ratio to the median
};
Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double median = values[values.size() / 2];
  return {median, values.back() / median};
}

Spread sweep(const char* name, const std::function<double(double)>& value_at) {
  std::vector<double> values;
  for (const double offset : offsets) values.push_back(value_at(offset));
  const auto spread = spread_of(values);
  std::printf("%-34s median %.3e, worst %.3g times that\n", name, spread.median, spread.worst);
  return spread;
}

TEST(FluidSweep, ErrorsAreBounded) {
  const auto weights = derived_weights(0.0, 1.0);
  std::map<double, FlowErrors> errors;
  for (const double offset : offsets) errors[offset] = errors_at(offset, weights);
  EXPECT_LT(sweep("u H1", [&](double offset) { return errors[offset].velocity_h1; }).worst, 1.3);
  EXPECT_LT(sweep("u L2", [&](double offset) { return errors[offset].velocity_l2; }).worst, 1.5);
  EXPECT_LT(sweep("p L2", [&](double offset) { return errors[offset].pressure_l2; }).worst, 2);
}

/// The jump of the divergence over all facets holds the velocity of small parts, too. Without it, the ghost
/// penalty has to bound the condition number alone; without both, nothing does.
TEST(FluidSweep, ConditionIsBoundedByTheGhostPenalty) {
  auto weights = derived_weights(0.0, 1.0);
  const auto condition = [&](double offset) { return condition_at(offset, weights); };
  EXPECT_LT(sweep("condition, defaults", condition).worst, 2);
  weights.divergence = 0;
  EXPECT_LT(sweep("condition, no divergence jump", condition).worst, 2);
  weights.ghost_viscous = weights.ghost_inertial = weights.ghost_pressure = 0;
  EXPECT_GT(sweep("condition, no ghost penalty either", condition).worst, 1e4);
}

} // namespace
} // namespace undula::verification
