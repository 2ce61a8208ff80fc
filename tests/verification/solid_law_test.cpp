// The nonlinear laws cell by cell: forces are derivatives of the energy, tangents derivatives of the forces.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "fom/assembly/nonlinear_solid.hpp"
#include "fom/system/operators.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

using Response = CellResponse<2>;
using Values = Response::Values;

struct LawCase {
  Space space;
  SolidModel model;
};

class SolidLaw : public testing::TestWithParam<LawCase> {
protected:
  /// A solid on a mesh without symmetry, away from the axis by `shift`.
  Discretisation<2> solid(double poisson, double damping_time, SolidModel model) const {
    SolidBody<2> body;
    body.mesh = warped_square(2);
    for (auto& x : body.mesh.points) x += Point<2>(0.4, -0.3);
    body.properties = {1.0, 3.0, poisson, damping_time};
    body.model = model;
    return discretise(in_vacuo(GetParam().space, std::move(body)), CutOptions{});
  }
  Discretisation<2> solid(double poisson, double damping_time) const {
    return solid(poisson, damping_time, GetParam().model);
  }
};

/// Smooth without any symmetry, of strains around `size`.
Values wave(double size, double phase) {
  Values values;
  for (int i = 0; i < Response::size; ++i) values[i] = size * std::sin(2.7 * i * i + phase);
  return values;
}

/// Central difference of `f` along every unknown, of fourth order.
template <class F>
auto derivative(const Values& at, int i, F&& f) -> decltype(f(at)) {
  constexpr double step = 1e-3;
  const auto moved = [&](double by) {
    Values values = at;
    values[i] += by;
    return f(values);
  };
  return ((8 * (moved(step) - moved(-step)) - (moved(2 * step) - moved(-2 * step))) / (12 * step));
}

TEST_P(SolidLaw, ForceIsTheDerivativeOfTheEnergyAndTangentOfTheForce) {
  const auto disc = solid(0.4, 0.7);
  const Values d = wave(0.03, 0.2), v = wave(0.4, 1.3);
  double force_error = 0, by_d_error = 0, by_v_error = 0;
  for (int c = 0; c < 8; ++c) {
    const SolidCell cell{0, c};
    const auto here = cell_response<2>(disc, cell, d, v, true);
    const double force = here.elastic.norm();
    ASSERT_GT(force, 1e-3);
    ASSERT_GT(here.viscous.norm(), 1e-3);
    for (int i = 0; i < Response::size; ++i) {
      const double from_energy =
          derivative(d, i, [&](const Values& x) { return cell_response<2>(disc, cell, x, v, false).energy; });
      force_error = std::max(force_error, std::abs(from_energy - here.elastic[i]) / force);
      const auto forces = [&](const Values& x, const Values& y) -> Values {
        const auto there = cell_response<2>(disc, cell, x, y, false);
        return there.elastic + there.viscous;
      };
      const Values by_d = derivative(d, i, [&](const Values& x) -> Values { return forces(x, v); });
      const Values by_v = derivative(v, i, [&](const Values& y) -> Values { return forces(d, y); });
      by_d_error = std::max(by_d_error, (by_d - here.by_d.col(i)).norm() / here.by_d.norm());
      by_v_error = std::max(by_v_error, (by_v - here.by_v.col(i)).norm() / here.by_v.norm());
    }
  }
  std::printf("relative errors: force %.1e, tangent by d %.1e, by v %.1e\n", force_error, by_d_error,
              by_v_error);
  EXPECT_LT(force_error, 1e-6);
  EXPECT_LT(by_d_error, 1e-6);
  EXPECT_LT(by_v_error, 1e-6);
}

/// Rotations keep the axis of axisymmetric space only there: plane space alone has them.
TEST_P(SolidLaw, KnowsRigidMotions) {
  const auto disc = solid(0.49, 0.7);
  const bool plane = GetParam().space == Space::plane;
  const double angle = 2.2; // rad
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  if (plane) turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  Eigen::Matrix2d spin = Eigen::Matrix2d::Zero(); // velocity = spin * (turned position)
  if (plane) spin << 0, -3, 3, 0;
  for (int c = 0; c < 8; ++c) {
    const SolidCell cell{0, c};
    Values d, v;
    for (int k = 0; k < 6; ++k) {
      const auto& X = disc.solid_spaces[0].nodes[disc.solid_spaces[0].cell_nodes[c][k]];
      d.segment<2>(2 * k) = turn * X - X + Point<2>(plane ? 5.0 : 0.0, -7.0);
      v.segment<2>(2 * k) = spin * (turn * X) + Point<2>(0.0, 1.5);
    }
    const auto moved = cell_response<2>(disc, cell, d, v, false);
    EXPECT_LT(moved.elastic.norm(), 1e-12);
    EXPECT_LT(moved.viscous.norm(), 1e-12);
    EXPECT_LT(std::abs(moved.energy), 1e-12);
    EXPECT_NEAR(moved.smallest_volume_ratio, 1, 1e-12);
    // The same motion with a stretch does leave stresses: what is zero above is not zero by default.
    EXPECT_GT(cell_response<2>(disc, cell, 1.01 * d + wave(0.01, 0.0), v, false).elastic.norm(), 1e-4);
  }
}

TEST_P(SolidLaw, IsTheLinearLawAtSmallStrains) {
  const auto linear = solid(0.49, 0.7, SolidModel::linear), nonlinear = solid(0.49, 0.7);
  PhaseTimer timer;
  const auto operators = build_operators(linear, MPI_COMM_SELF, timer);
  const auto cells = build_operators(nonlinear, MPI_COMM_SELF, timer).nonlinear_cells;
  ASSERT_EQ(cells.size(), 8u);
  Eigen::VectorXd shape(linear.unknowns());
  for (int i = 0; i < shape.size(); ++i) shape[i] = std::sin(1.9 * i * i + 0.4);
  double coarse = 0;
  for (const double size : {1e-4, 1e-5}) {
    const Eigen::VectorXd d = size * shape, v = 3 * size * shape;
    const auto response = solid_response<2>(nonlinear, cells, d, v, {}, false);
    const Eigen::VectorXd force = operators.stiffness * d, damping = operators.damping * v;
    const double error = (response.elastic - force).norm() / force.norm();
    std::printf("displacements of %.0e: force differs from the linear law's by %.2e\n", size, error);
    EXPECT_LT(error, 100 * size);
    EXPECT_LT((response.viscous - damping).norm(), 100 * size * damping.norm());
    EXPECT_NEAR(response.energy, 0.5 * d.dot(force), 100 * size * d.dot(force));
    if (coarse > 0) {
      EXPECT_NEAR(coarse / error, 10, 0.5); // the difference is of second order
    }
    coarse = error;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, SolidLaw,
                         testing::Values(LawCase{Space::plane, SolidModel::saint_venant_kirchhoff},
                                         LawCase{Space::plane, SolidModel::neo_hookean},
                                         LawCase{Space::axisymmetric, SolidModel::saint_venant_kirchhoff},
                                         LawCase{Space::axisymmetric, SolidModel::neo_hookean}),
                         [](const auto& instance) {
                           return std::string(instance.param.space == Space::plane ? "Plane"
                                                                                   : "Axisymmetric") +
                                  (instance.param.model == SolidModel::neo_hookean ? "NeoHooke"
                                                                                   : "SaintVenantKirchhoff");
                         });

/// Hand-made answers of the neo-Hookean law: a uniform stretch of plane strain.
TEST(NeoHookeanLaw, HasTheStressesOfAUniformStretch) {
  const LameConstants lame{7.0, 2.0};
  const double a = 1.3, b = 0.9;
  const Eigen::Matrix3d F = Eigen::Vector3d(a, b, 1.0).asDiagonal();
  const auto response = material_response<2>(SolidModel::neo_hookean, lame, F - Eigen::Matrix3d::Identity());
  const double log_J = std::log(a * b);
  // Cauchy stress: (mu (B - 1) + lambda ln J) / J.
  const auto cauchy = [&](double stretch) {
    return (lame.mu * (stretch * stretch - 1) + lame.lambda * log_J) / (a * b);
  };
  EXPECT_NEAR(response.stress[0] * a * a / (a * b), cauchy(a), 1e-13);
  EXPECT_NEAR(response.stress[1] * b * b / (a * b), cauchy(b), 1e-13);
  EXPECT_NEAR(response.stress[2] / (a * b), cauchy(1), 1e-13);
}

} // namespace
} // namespace undula::verification
