// What data add to tolerances: linear models, where everything is known in closed form.
#include "training/calibration/posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "rom/base/error.hpp"
#include "training/calibration/profile.hpp"

namespace undula::training {
namespace {

/// Q = slope . inputs at some heads, with independent normal inputs.
struct LinearModel {
  Eigen::MatrixXd slope; ///< flows x inputs
  Eigen::VectorXd value, deviation;

  [[nodiscard]] UncertaintyBand band() const {
    UncertaintyBand result;
    result.half_width.assign(static_cast<std::size_t>(slope.rows()), 0.0);
    for (Eigen::Index i = 0; i < slope.cols(); ++i) {
      const double tolerance = deviations_of_95_percent * deviation[i];
      InputEffect input{"input" + std::to_string(i), value[i], tolerance, {}, {}, ""};
      for (Eigen::Index k = 0; k < slope.rows(); ++k) {
        input.up.push_back(slope(k, i) * tolerance);
        input.down.push_back(-slope(k, i) * tolerance);
      }
      result.inputs.push_back(input);
    }
    return result;
  }
};

const Eigen::Vector3d deviations_of_flow(0.1, 0.1, 0.2);

LinearModel given() {
  LinearModel model;
  model.slope.resize(3, 2);
  model.slope << 1.0, 2.0, 1.5, 1.0, 0.5, -1.0;
  model.value = Eigen::Vector2d(3, 4);
  model.deviation = Eigen::Vector2d(0.5, 0.2);
  return model;
}

LinearModel predicted() {
  LinearModel model = given();
  model.slope.resize(1, 2);
  model.slope << 2.0, 0.5;
  return model;
}

// Against the covariance in the space of the flows, the other form of the same law: C - C A^T (A C A^T +
// R)^-1 A C.
TEST(Posterior, IsThatOfNormalNumbers) {
  const LinearModel model = given();
  const Eigen::Vector3d residual(0.3, -0.1, 0.2);
  const Posterior posterior =
      condition_on_data(model.band(), residual, deviations_of_flow, predicted().band());

  const Eigen::MatrixXd prior = model.deviation.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd noise = deviations_of_flow.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd gain =
      prior * model.slope.transpose() * (model.slope * prior * model.slope.transpose() + noise).inverse();
  const Eigen::MatrixXd covariance = prior - gain * model.slope * prior;
  const Eigen::VectorXd shift = gain * residual;
  for (Eigen::Index i = 0; i < 2; ++i) {
    const PosteriorInput& input = posterior.inputs[static_cast<std::size_t>(i)];
    EXPECT_NEAR(input.tolerance_given, deviations_of_95_percent * std::sqrt(covariance(i, i)), 1e-12);
    EXPECT_NEAR(input.shift, shift[i], 1e-12);
    // Without the own tolerance: as if it were very wide.
    Eigen::MatrixXd wide = prior;
    wide(i, i) *= 1e5;
    const Eigen::MatrixXd wide_gain =
        wide * model.slope.transpose() * (model.slope * wide * model.slope.transpose() + noise).inverse();
    const double by_data = std::sqrt((wide - wide_gain * model.slope * wide)(i, i));
    EXPECT_NEAR(input.tolerance_by_data, deviations_of_95_percent * by_data, 1e-3 * input.tolerance_by_data);
  }
  EXPECT_NEAR(posterior.correlation(0, 1), covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)),
              1e-12);
  const Eigen::VectorXd effect = predicted().slope.row(0);
  EXPECT_NEAR(posterior.half_width[0], deviations_of_95_percent * std::sqrt(effect.dot(covariance * effect)),
              1e-12);
  EXPECT_NEAR(posterior.shift[0], effect.dot(shift), 1e-12);
  EXPECT_NEAR(posterior.misfit, std::sqrt((9 + 1 + 1) / 3.0), 1e-12);
}

TEST(Posterior, DataWithoutInfluenceChangeNothing) {
  LinearModel model = given();
  model.slope.setZero();
  const Posterior posterior =
      condition_on_data(model.band(), Eigen::Vector3d(1, 2, 3), deviations_of_flow, predicted().band());
  for (const PosteriorInput& input : posterior.inputs) {
    EXPECT_DOUBLE_EQ(input.tolerance_given, input.tolerance);
    EXPECT_EQ(input.shift, 0);
    EXPECT_TRUE(std::isinf(input.tolerance_by_data));
  }
  EXPECT_NEAR(posterior.half_width[0], deviations_of_95_percent * std::hypot(2 * 0.5, 0.5 * 0.2), 1e-12);
}

/// The same model as a calibration: keys held by their tolerances, flows measured with the residuals of a
/// shift.
struct HeldFit {
  LinearModel model = given();
  Eigen::Vector3d residual{0.3, -0.1, 0.2};
  std::vector<FreeKey> keys;
  std::vector<TargetCurve> targets;

  HeldFit() {
    for (Eigen::Index i = 0; i < 2; ++i)
      keys.push_back({"input" + std::to_string(i), model.value[i] - 3 * model.deviation[i],
                      model.value[i] + 3 * model.deviation[i], model.deviation[i], model.value[i]});
    const Eigen::VectorXd flow = model.slope * model.value + residual;
    for (Eigen::Index k = 0; k < 3; ++k)
      targets.push_back({"curve", 120, 0.53, {50.0}, {flow[k]}, deviations_of_flow[k], 0});
  }
  [[nodiscard]] std::optional<Eigen::VectorXd> flows(const Eigen::VectorXd& values) const {
    return Eigen::VectorXd(model.slope * values);
  }
};

TEST(Posterior, IsWhereAFitHeldByTolerancesEnds) {
  const HeldFit fit;
  const auto calibration = calibrate([&](const Eigen::VectorXd& values) { return fit.flows(values); },
                                     fit.keys, fit.model.value, fit.targets);
  // The noise of the flows counts in a fit.
  const Eigen::VectorXd deviation =
      deviations_of_flow.unaryExpr([](double scatter) { return std::hypot(scatter, flow_noise_l_per_min); });
  const Posterior posterior =
      condition_on_data(fit.model.band(), fit.residual, deviation, predicted().band());
  double misfit = 0;
  const Eigen::VectorXd left =
      fit.model.slope * calibration.optimum - fit.model.slope * fit.model.value - fit.residual;
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(calibration.optimum[i],
                fit.model.value[i] + posterior.inputs[static_cast<std::size_t>(i)].shift, 1e-5);
    misfit += std::pow((calibration.optimum[i] - fit.model.value[i]) / fit.model.deviation[i], 2);
  }
  misfit += left.cwiseQuotient(deviation).squaredNorm();
  EXPECT_NEAR(calibration.misfit, misfit, 1e-9);
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_NEAR(calibration.curves[static_cast<std::size_t>(k)].optimum_rms_l_per_min, std::abs(left[k]),
                1e-9);
}

// At the ends of the interval by the data alone the misfit is higher by 1.96^2.
TEST(Posterior, AProfileRisesByTheSquareOfTheDeviations) {
  const HeldFit fit;
  const auto flows = [&](double value, std::span<const FreeKey>) -> FlowsOfValues {
    return
        [&fit, value](const Eigen::VectorXd& others) { return fit.flows(Eigen::Vector2d(value, others[0])); };
  };
  const Eigen::VectorXd deviation =
      deviations_of_flow.unaryExpr([](double scatter) { return std::hypot(scatter, flow_noise_l_per_min); });
  // Its own tolerance left out, the best value is that of a very wide one.
  LinearModel wide = fit.model;
  wide.deviation[0] = 1e3;
  const auto input = condition_on_data(wide.band(), fit.residual, deviation, predicted().band()).inputs[0];
  const double best = fit.model.value[0] + input.shift, half = input.tolerance_by_data;
  const auto profile = profile_likelihood(flows, {"input0", {best - half, best, best + half}}, fit.keys,
                                          fit.model.value, fit.targets);
  ASSERT_EQ(profile.size(), 3u);
  for (const ProfilePoint& point : profile) {
    EXPECT_TRUE(point.computed);
    EXPECT_EQ(point.others.size(), 1);
  }
  const double rise = std::pow(deviations_of_95_percent, 2);
  EXPECT_NEAR(profile[0].misfit - profile[1].misfit, rise, 1e-3);
  EXPECT_NEAR(profile[2].misfit - profile[1].misfit, rise, 1e-3);
}

// Draws of linear flows have the mean and the covariance of the law, whatever the number of steps.
TEST(Posterior, DrawsAreThoseOfTheLaw) {
  const LinearModel model = given();
  const Eigen::Vector3d residual(0.3, -0.1, 0.2);
  const Eigen::VectorXd measured = model.slope * model.value + residual;
  const FlowsOfValues flows = [&](const Eigen::VectorXd& values) {
    return Eigen::VectorXd(model.slope * values);
  };
  const int count = 20000;
  const auto ensemble = draw_inputs(model.band(), measured, deviations_of_flow, flows, count, 7);
  ASSERT_EQ(ensemble.values.rows(), count);
  EXPECT_EQ(ensemble.refused, 0);
  const Posterior posterior =
      condition_on_data(model.band(), residual, deviations_of_flow, predicted().band());
  const Eigen::VectorXd mean = ensemble.values.colwise().mean();
  const Eigen::MatrixXd centred = ensemble.values.rowwise() - mean.transpose();
  const Eigen::MatrixXd covariance = centred.transpose() * centred / (count - 1);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const PosteriorInput& input = posterior.inputs[static_cast<std::size_t>(i)];
    const double deviation = input.tolerance_given / deviations_of_95_percent;
    EXPECT_NEAR(mean[i], input.value + input.shift, 0.03 * deviation);
    EXPECT_NEAR(std::sqrt(covariance(i, i)), deviation, 0.02 * deviation);
  }
  EXPECT_NEAR(covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), posterior.correlation(0, 1),
              0.02);
  EXPECT_EQ(draw_inputs(model.band(), measured, deviations_of_flow, flows, 5, 7).values,
            ensemble.values.topRows(5));
}

// Where the flow is curved, a draw ends at the optimum of its own moved problem, not at that of the slopes.
TEST(Posterior, DrawsFollowAFlowThatIsCurved) {
  LinearModel line;
  line.slope = Eigen::MatrixXd::Constant(1, 1, 1.0);
  line.value = Eigen::VectorXd::Constant(1, 1.0);
  line.deviation = Eigen::VectorXd::Constant(1, 1.0);
  const FlowsOfValues square = [](const Eigen::VectorXd& x) -> std::optional<Eigen::VectorXd> {
    if (x[0] < 0) return std::nullopt;
    return Eigen::VectorXd((x.array().square() + 1) / 2); // slope 1 at 1
  };
  const Eigen::VectorXd exact = Eigen::VectorXd::Constant(1, 1e-4);
  const auto ensemble = draw_inputs(line.band(), Eigen::VectorXd::Constant(1, 1.2), exact, square, 50, 3);
  for (const double value : ensemble.values.col(0)) EXPECT_NEAR(value, std::sqrt(1.4), 5e-3);
  EXPECT_GT(ensemble.values.rows(), 40);
}

} // namespace
} // namespace undula::training
