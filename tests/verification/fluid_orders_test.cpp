// Orders of convergence of the fluid by manufactured solutions: Stokes and Navier-Stokes, plane and
// axisymmetric, uncut and cut by a solid at rest that no edge of the mesh follows.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "fom/problem/default_weights.hpp"
#include "tests/verification/support/flow_gallery.hpp"
#include "tests/verification/support/steady_flow.hpp"

namespace undula::verification {
namespace {

const TurnedBox turned_box_section{{0.52, 0.47}, 0.21, 0.13, 0.4};
const TurnedBox ring_section{{0.53, 0.46}, 0.17, 0.14, 0};

SimplexMesh<2> mesh_of(const TurnedBox& box) {
  return turned_box(box.centre, box.half_x, box.half_y, box.angle, 4, 3);
}

/// Measured order between the two finest of a sequence of meshes whose size is halved.
double last_order(const std::vector<double>& errors) {
  return std::log2(errors[errors.size() - 2] / errors.back());
}

struct Regime {
  const char* name;
  bool convects = false;
  VelocityScale scale = VelocityScale::reference;
};
constexpr Regime regimes[] = {
    {"Stokes"}, {"Navier-Stokes", true}, {"Navier-Stokes, local scale", true, VelocityScale::local}};

/// Least orders of u in L2 and H1 and of p in L2.
struct Orders {
  double velocity, gradient, pressure;
};
constexpr Orders linear{1.8, 0.9, 1.0}, quadratic{2.8, 1.9, 1.9};

void expect_orders(const char* name, ManufacturedFlow flow, const TurnedBox* box, int velocity_order = 1) {
  const auto& least = velocity_order == 2 ? quadratic : linear;
  for (const auto& regime : regimes) {
    const bool convects = regime.convects;
    flow.convects = convects;
    flow.viscosity = convects ? 0.05 : 1.0;
    std::vector<double> velocity, gradient, pressure;
    for (const int n : velocity_order == 2 ? std::vector{8, 16, 32} : std::vector{8, 16, 32, 64}) {
      auto weights = derived_weights(convects ? 1.0 : 0.0, 1.0, velocity_order);
      weights.velocity_scale = regime.scale;
      const auto solid = box ? std::optional(mesh_of(*box)) : std::nullopt;
      auto problem = manufactured_problem(flow, warped_square(n), solid, weights);
      problem.velocity_order = velocity_order;
      const auto errors = solve_manufactured(flow, problem);
      velocity.push_back(errors.velocity_l2);
      gradient.push_back(errors.velocity_h1);
      pressure.push_back(errors.pressure_l2);
      std::printf("%-22s %-26s n = %2d   u L2 %.3e   u H1 %.3e   p L2 %.3e\n", name, regime.name, n,
                  errors.velocity_l2, errors.velocity_h1, errors.pressure_l2);
    }
    std::printf("%-22s %-26s order    u L2 %.2f        u H1 %.2f        p L2 %.2f\n", name, regime.name,
                last_order(velocity), last_order(gradient), last_order(pressure));
    EXPECT_GE(last_order(velocity), least.velocity);
    EXPECT_GE(last_order(gradient), least.gradient);
    EXPECT_GE(last_order(pressure), least.pressure);
  }
}

TEST(FluidOrders, Plane) { expect_orders("plane", plane_vortex(), nullptr); }
TEST(FluidOrders, PlaneCut) {
  expect_orders("plane, cut", plane_flow_around(turned_box_section), &turned_box_section);
}
TEST(FluidOrders, Axisymmetric) { expect_orders("axisymmetric", axisymmetric_vortex(), nullptr); }
TEST(FluidOrders, AxisymmetricCut) {
  expect_orders("axisymmetric, cut", axisymmetric_flow_around(ring_section), &ring_section);
}

TEST(FluidOrders, QuadraticPlane) { expect_orders("plane, P2-P1", plane_vortex(), nullptr, 2); }
TEST(FluidOrders, QuadraticPlaneCut) {
  expect_orders("plane, cut, P2-P1", plane_flow_around(turned_box_section), &turned_box_section, 2);
}
TEST(FluidOrders, QuadraticAxisymmetric) {
  expect_orders("axisymmetric, P2-P1", axisymmetric_vortex(), nullptr, 2);
}
TEST(FluidOrders, QuadraticAxisymmetricCut) {
  expect_orders("axisymmetric, cut, P2-P1", axisymmetric_flow_around(ring_section), &ring_section, 2);
}

/// Stress divergence by central differences of the exact velocity and pressure, in the form div sigma with
/// hoop stress: nothing of the differentiation or of the Laplacian form that `sample` uses is shared.
Point<2> force_by_differences(const ManufacturedFlow& flow, const Point<2>& x) {
  const double step = 1e-4;
  const bool ring = flow.space == Space::axisymmetric;
  const auto gradient = [&](const Point<2>& at) {
    Eigen::Matrix2d g;
    for (int j = 0; j < 2; ++j) {
      const Point<2> d = step * Point<2>::Unit(j);
      g.col(j) = (velocity_at(flow, at + d) - velocity_at(flow, at - d)) / (2 * step);
    }
    return g;
  };
  const auto stress = [&](const Point<2>& at) -> Eigen::Matrix2d {
    const auto g = gradient(at);
    const double p = flow.pressure(Jet(at[0]), Jet(at[1])).value();
    return flow.viscosity * (g + g.transpose()) - p * Eigen::Matrix2d::Identity();
  };
  Point<2> force = Point<2>::Zero();
  for (int j = 0; j < 2; ++j) {
    const Point<2> d = step * Point<2>::Unit(j);
    force -= (stress(x + d) - stress(x - d)).col(j) / (2 * step);
  }
  const Point<2> u = velocity_at(flow, x);
  if (ring) {
    const double hoop = 2 * flow.viscosity * u[0] / x[0] - flow.pressure(Jet(x[0]), Jet(x[1])).value();
    force -= (stress(x).col(0) - Point<2>(hoop, 0)) / x[0];
  }
  if (flow.convects) force += flow.density * gradient(x) * u;
  return force;
}

TEST(FluidOrders, ForcesMatchFiniteDifferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.05, 0.95);
  for (auto flow : {plane_vortex(), plane_flow_around(turned_box_section), axisymmetric_vortex(),
                    axisymmetric_flow_around(ring_section)}) {
    flow.convects = true;
    flow.density = 1.3;
    flow.viscosity = 0.7;
    for (int i = 0; i < 20; ++i) {
      const Point<2> x(place(random), place(random));
      const auto exact = sample(flow, x);
      const double size = 1 + exact.force.norm();
      EXPECT_LT((exact.force - force_by_differences(flow, x)).norm(), 1e-5 * size) << x.transpose();
      double divergence = exact.gradient.trace();
      if (flow.space == Space::axisymmetric) divergence += exact.velocity[0] / x[0];
      EXPECT_NEAR(divergence, 0, 1e-11);
      EXPECT_LT((exact.velocity - velocity_at(flow, x)).norm(), 1e-12 * size);
    }
  }
}

TEST(FluidOrders, FlowsVanishOnTheirSolids) {
  for (const auto& [flow, box] : {std::pair(plane_flow_around(turned_box_section), turned_box_section),
                                  std::pair(axisymmetric_flow_around(ring_section), ring_section)}) {
    const auto mesh = mesh_of(box);
    for (const auto& facet : mesh.boundary)
      EXPECT_LT(
          velocity_at(flow, 0.3 * mesh.points[facet.points[0]] + 0.7 * mesh.points[facet.points[1]]).norm(),
          1e-12);
  }
}

} // namespace
} // namespace undula::verification
