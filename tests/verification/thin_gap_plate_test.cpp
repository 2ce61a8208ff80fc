// The plate of the thin-gap level in vacuo: against Mindlin's differential equations, Kirchhoff's formulas,
// the full-order solid, and von Karman's equations at large deflection.
#include "tests/verification/support/thin_gap_plate.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cstdio>
#include <numbers>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "geometry/wave_pump/profile.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/plate_theory.hpp"
#include "tests/verification/support/solid_meshes.hpp"
#include "tests/verification/support/thin_gap_mindlin.hpp"
#include "tests/verification/support/thin_gap_von_karman.hpp"

namespace undula::verification {
namespace {

constexpr double young = 1.686e7, poisson = 0.49, density = 1.125; // g, cm, s
constexpr double pressure = 1000;                                  // dyn/cm^2
constexpr int modes = 3;

double per_cent(double value, double exact) { return 100 * (value / exact - 1); }
double hertz(double omega) { return omega / (2 * std::numbers::pi); }

/// The free part of the pump's membrane with all thicknesses times `thinner`.
struct PumpMembrane {
  MembraneProfile profile;
  double thinner = 1;

  double thickness(double r) const { return thinner * membrane_thickness(profile, r); }
  double corner() const { return profile.thickness.points[1].x(); }
};

PumpMembrane pump_membrane_part(double thinner) {
  const auto profile =
      read_pump_profile(std::string(UNDULA_SOURCE_DIR) + "/data/profiles/wave_pump_profile.toml");
  return {profile.membrane, thinner};
}

/// The level's plate with the nodes of its own layout: steps that grow from the tip.
ThinGapPlate level_plate(const PumpMembrane& membrane, int cells) {
  ThinGapPlate plate;
  plate.material = {density, young, poisson, 0.0};
  auto& layout = plate.layout;
  layout = uniform_plate(membrane.profile.inner_radius, membrane.profile.clamp_radius, 1.0, cells);
  const double length = membrane.profile.clamp_radius - membrane.profile.inner_radius;
  for (int i = 0; i <= cells; ++i) {
    const double s = static_cast<double>(i) / cells;
    layout.radius[i] = membrane.profile.inner_radius + length * s * (0.25 + 0.75 * s);
    layout.thickness[i] = membrane.thickness(layout.radius[i]);
  }
  return plate;
}

MindlinPlate mindlin_plate(const PumpMembrane& membrane) {
  const auto& profile = membrane.profile;
  return {{profile.inner_radius, membrane.corner(), profile.clamp_radius},
          [membrane](double r) { return membrane.thickness(r); },
          young,
          poisson,
          density};
}

/// Deflection of the tip and frequencies of one and the same plate.
struct PlateNumbers {
  double deflection = 0; ///< cm
  std::vector<double> omega;
};

PlateNumbers of_level(const ThinGapPlate& plate) {
  return {plate.solve(plate.load(pressure), Eigen::VectorXd::Zero(plate.size()), 1)[0],
          plate.frequencies(modes)};
}
PlateNumbers of_mindlin(const MindlinPlate& plate) {
  return {plate.deflection(pressure), plate.frequencies(modes)};
}

/// Coordinates from `low` to `high` in steps of at most `coarse`, finer towards `high` down to `fine`.
std::vector<double> refined_to_end(double low, double high, double coarse, double fine) {
  constexpr double growth = 0.35; // of the step per distance from the end
  std::vector<double> x{high};
  while (x.back() > low + 1e-12) {
    const double step = std::min(coarse, fine + growth * (high - x.back()));
    x.push_back(x.back() - step < low + 0.6 * step ? low : x.back() - step);
  }
  std::reverse(x.begin(), x.end());
  return x;
}

/// The full-order solid on quadratic elements as long as `coarse` times the thickness at the clamp, `nz` of
/// them across, refined towards the ends of the clamp, where its stress is singular. The load acts as a body
/// force.
PlateNumbers of_solid(const PumpMembrane& membrane, double coarse, int nz, double fine) {
  const double inner = membrane.profile.inner_radius, outer = membrane.profile.clamp_radius;
  const double h = membrane.thickness(outer);
  const auto parts = static_cast<int>(std::lround((membrane.corner() - inner) / (coarse * h)));
  std::vector<double> columns = spaced(inner, membrane.corner(), parts);
  const std::vector<double> beyond = refined_to_end(membrane.corner(), outer, coarse * h, fine * h);
  columns.insert(columns.end(), beyond.begin() + 1, beyond.end());
  const std::vector<double> upper = refined_to_end(0.0, 0.5, 1.0 / nz, fine);
  std::vector<double> rows;
  for (std::size_t i = upper.size(); i-- > 1;) rows.push_back(-upper[i]);
  rows.insert(rows.end(), upper.begin(), upper.end());
  SolidBody<2> body;
  body.mesh = tensor_mesh(columns, rows);
  for (auto& x : body.mesh.points) x.y() *= membrane.thickness(x.x());
  body.properties = {density, young, poisson, 0.0};
  body.imposed = [=](const Point<2>& x) { return x[0] > outer * (1 - 1e-9); };
  body.body_force = [=](const Point<2>& x, double t) {
    return Point<2>(0.0, t <= 0 ? pressure / membrane.thickness(x[0]) : 0.0);
  };
  PhaseTimer timer;
  const auto disc = discretise(in_vacuo(Space::axisymmetric, std::move(body)), CutOptions{});
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady(disc, operators, 1e-10, 1, timer, d);

  // Subspace iteration with the factored stiffness, by Rayleigh and Ritz.
  const FreeUnknowns free(disc.is_constrained);
  const Eigen::SparseMatrix<double> stiffness = free.restrict_to_free(operators.stiffness);
  const Eigen::SparseMatrix<double> mass = free.restrict_to_free(operators.mass);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factored(stiffness);
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(free.size(), 8);
  for (int i = 0; i < free.size(); ++i)
    for (int k = 0; k < block.cols(); ++k) block(i, k) = std::sin(0.37 * (i + 1) * (k + 1));
  Eigen::VectorXd squares;
  for (int iteration = 0; iteration < 25; ++iteration) {
    block = factored.solve(mass * block);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(
        block.transpose() * (stiffness * block), block.transpose() * (mass * block));
    block = block * ritz.eigenvectors();
    squares = ritz.eigenvalues();
  }
  PlateNumbers numbers{d[disc.solid_unknown(0, node_at(disc, 0, {inner, 0.0}), 1)], {}};
  for (int k = 0; k < modes; ++k) numbers.omega.push_back(std::sqrt(squares[k]));
  return numbers;
}

void print(const char* what, const PlateNumbers& numbers, const PlateNumbers& reference) {
  std::printf("%-28s w %.5e cm (%+.3f %%), f", what, numbers.deflection,
              per_cent(numbers.deflection, reference.deflection));
  for (int k = 0; k < modes; ++k)
    std::printf(" %.3f Hz (%+.3f %%)", hertz(numbers.omega[k]),
                per_cent(numbers.omega[k], reference.omega[k]));
  std::printf("\n");
}

void expect_near(const PlateNumbers& numbers, const PlateNumbers& reference, double tolerance) {
  EXPECT_NEAR(numbers.deflection, reference.deflection, tolerance * reference.deflection);
  for (int k = 0; k < modes; ++k)
    EXPECT_NEAR(numbers.omega[k], reference.omega[k], tolerance * reference.omega[k]) << "mode " << k + 1;
}

TEST(ThinGapPlate, TheTaperedMembraneFollowsMindlinsEquations) {
  const auto membrane = pump_membrane_part(1);
  const auto exact = of_mindlin(mindlin_plate(membrane));
  auto finer = mindlin_plate(membrane);
  finer.order = 28;
  const auto check = of_mindlin(finer);
  EXPECT_NEAR(exact.deflection, check.deflection, 1e-7 * check.deflection);
  EXPECT_NEAR(exact.omega[2], check.omega[2], 1e-7 * check.omega[2]);
  print("Mindlin, collocation:", exact, exact);
  for (const int cells : {34, 69, 138}) {
    const auto level = of_level(level_plate(membrane, cells));
    print(("level, " + std::to_string(cells) + " cells:").c_str(), level, exact);
    if (cells == 69) expect_near(level, exact, 0.005);
  }
}

TEST(ThinGapPlate, AUniformRingFollowsKirchhoffsFormulas) {
  const double inner = 0.25, h = 0.01;
  const PlateTheory theory{inner, 1.0, h, young, poisson, density};
  ThinGapPlate plate{uniform_plate(inner, 1.0, h, 96), {density, young, poisson, 0.0}};
  const auto level = of_level(plate);
  const MindlinPlate mindlin{{inner, 1.0}, [=](double) { return h; }, young, poisson, density};
  const double exact = theory.deflection(inner, pressure) + theory.shear_deflection(inner, pressure);
  std::printf(
      "uniform ring: w %+.3f %% (collocation %+.4f %%), f1 %+.3f %% of Kirchhoff (collocation %+.4f %%)\n",
      per_cent(level.deflection, exact), per_cent(mindlin.deflection(pressure), exact),
      per_cent(level.omega[0], theory.first_omega()),
      per_cent(mindlin.frequencies(1)[0], theory.first_omega()));
  EXPECT_NEAR(level.deflection, exact, 0.005 * exact);
  EXPECT_NEAR(mindlin.deflection(pressure), exact, 1e-6 * exact); // the reference itself
  EXPECT_NEAR(level.omega[0], theory.first_omega(), 0.005 * theory.first_omega());
  expect_near(level, of_mindlin(mindlin), 0.005);
}

/// A plate is a solid that is thin: what it leaves out shrinks with the thickness, here in proportion to it.
/// A solid of nu = 0.49 that is held cannot contract across its thickness, which stiffens its end over a part
/// of the thickness; no plate theory knows that. So the two agree within 0.5 % only where the plate is
/// thinner than the pump's.
TEST(ThinGapPlate, TheFullOrderSolidTendsToItAsItGetsThinner) {
  std::vector<double> difference;
  for (const double thinner : {1.0, 0.5, 0.25}) {
    const auto membrane = pump_membrane_part(thinner);
    const auto level = of_level(level_plate(membrane, 138));
    const auto solid = of_solid(membrane, 0.5, 2, 0.02);
    std::printf("thickness x %.2f\n", thinner);
    if (thinner == 1) { // the solid's own error is far below what is compared
      const auto finer = of_solid(membrane, 0.25, 4, 0.005);
      print(" solid, finer against solid:", finer, solid);
      expect_near(finer, solid, 0.001);
    }
    print(" level against the solid:", level, solid);
    difference.push_back(per_cent(level.omega[0], solid.omega[0]));
    expect_near(level, solid, thinner == 0.25 ? 0.005 : 0.015);
  }
  EXPECT_NEAR(difference[1] / difference[0], 0.5, 0.05);
  EXPECT_NEAR(difference[2] / difference[0], 0.25, 0.025);
}

class LargeDeflection : public testing::TestWithParam<double> {};

TEST_P(LargeDeflection, FollowsVonKarmansEquations) {
  const double inner = GetParam(), outer = 1.0, h = 0.01;
  const VonKarmanPlate exact_plate{inner, outer, h, young, poisson};
  auto finer = exact_plate;
  finer.order = 56;
  ThinGapPlate plate{
      uniform_plate(inner, outer, h, 96), {density, young, poisson, 0.0}, SolidModel::von_karman, inner == 0};
  ThinGapPlate linear = plate;
  linear.model = SolidModel::linear;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(plate.size());
  const double unit = exact_plate.stiffness() * h / std::pow(outer, 4); // pressure of w/h ~ 1/64 and up
  for (const double load : {20.0, 60.0, 200.0, 600.0, 1200.0}) {
    const double p = load * unit;
    const double exact = std::abs(exact_plate.deflection(p, 8));
    ASSERT_NEAR(std::abs(finer.deflection(p, 8)), exact, 1e-5 * exact);
    d = plate.solve(plate.load(p), d, 20);
    Eigen::VectorXd residual = plate.forces(d) - plate.load(p);
    if (plate.disc) residual[1] = residual[2] = 0;
    ASSERT_LT(residual.norm(), 1e-8 * plate.load(p).norm());
    const double stiff = linear.solve(linear.load(p), Eigen::VectorXd::Zero(plate.size()), 1)[0];
    std::printf("inner radius %.2f: w/h %.4f, exact %.4f (%+.3f %%); without stretching %.3f\n", inner,
                d[0] / h, exact / h, per_cent(d[0], exact), stiff / h);
    EXPECT_NEAR(d[0], exact, 0.01 * exact);
    // Stretching matters at the highest load.
    if (load == 1200) {
      EXPECT_GT(stiff, 1.5 * exact);
    }
  }
  EXPECT_GT(d[0] / h, 1.8);
}

INSTANTIATE_TEST_SUITE_P(Plates, LargeDeflection, testing::Values(0.0, 0.3), [](const auto& instance) {
  return std::string(instance.param == 0 ? "Disc" : "Ring");
});

} // namespace
} // namespace undula::verification
