#include "training/calibration/posterior.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace undula::training {
namespace {

/// Change of every flow (row) per standard deviation of every input (column).
Eigen::MatrixXd effects(const UncertaintyBand& band) {
  const auto flows = static_cast<Eigen::Index>(band.half_width.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(flows, static_cast<Eigen::Index>(band.inputs.size()));
  for (Eigen::Index i = 0; i < all.cols(); ++i)
    for (Eigen::Index k = 0; k < flows; ++k) {
      const double change =
          effect_of_tolerance(band.inputs[static_cast<std::size_t>(i)], static_cast<std::size_t>(k));
      if (std::isfinite(change)) all(k, i) = change / deviations_of_95_percent;
    }
  return all;
}

struct FittedDraw {
  Eigen::VectorXd unit, flows; ///< inputs in deviations from their stated values; flows there
};

/// Least of |unit - prior|^2 + |(target - flows(unit)) / deviation|^2 from unit = 0: steps of Gauss and
/// Newton, halved where they lead upwards, with `slopes` (in deviations) that follow the flows by Broyden's
/// update. Nothing where no flow can be had, or the sum stays far above what is probable.
std::optional<FittedDraw> fit_draw(const Eigen::VectorXd& prior, const Eigen::VectorXd& target,
                                   const Eigen::VectorXd& deviation, Eigen::MatrixXd slopes,
                                   const Eigen::VectorXd& flows_at_zero, const FlowsOfValues& flows) {
  constexpr int most_steps = 8, halvings = 3;
  constexpr double short_step = 0.1, small_gain = 0.02; // in deviations of the answer, of the sum of squares
  const Eigen::Index inputs = slopes.cols();
  FittedDraw draw{Eigen::VectorXd::Zero(inputs), flows_at_zero};
  const auto sum_of_squares = [&](const Eigen::VectorXd& unit, const Eigen::VectorXd& at) {
    return (unit - prior).squaredNorm() + (target - at).cwiseQuotient(deviation).squaredNorm();
  };
  double sum = sum_of_squares(draw.unit, draw.flows);
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::LLT<Eigen::MatrixXd> precision(Eigen::MatrixXd::Identity(inputs, inputs) +
                                                slopes.transpose() * slopes);
    Eigen::VectorXd change = precision.solve(
        prior - draw.unit + slopes.transpose() * (target - draw.flows).cwiseQuotient(deviation));
    if ((precision.matrixU() * change).norm() < short_step) return draw;
    double gain = 0;
    for (int halving = 0; halving <= halvings && gain <= 0; ++halving, change /= 2) {
      const auto there = flows(draw.unit + change);
      if (!there) continue;
      const Eigen::VectorXd missed = (*there - draw.flows).cwiseQuotient(deviation) - slopes * change;
      slopes += missed * change.transpose() / change.squaredNorm();
      const double next = sum_of_squares(draw.unit + change, *there);
      if (next >= sum) continue;
      gain = sum - next;
      sum = next;
      draw.unit += change;
      draw.flows = *there;
    }
    if (gain <= 0) break;
    if (gain <= small_gain) return draw;
  }
  // At its minimum the sum is that of as many squares of normal numbers as there are flows.
  const auto size = static_cast<double>(target.size());
  return sum <= size + 4 * std::sqrt(2 * size) ? std::optional(draw) : std::nullopt;
}

} // namespace

Posterior condition_on_data(const UncertaintyBand& given, const Eigen::VectorXd& residual,
                            const Eigen::VectorXd& deviation, const UncertaintyBand& predicted) {
  const Eigen::MatrixXd seen = deviation.cwiseInverse().asDiagonal() * effects(given);
  const Eigen::Index inputs = seen.cols();
  const Eigen::VectorXd left = residual.cwiseQuotient(deviation);
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(inputs, inputs) + seen.transpose() * seen;
  const Eigen::MatrixXd covariance = precision.llt().solve(Eigen::MatrixXd::Identity(inputs, inputs));
  const Eigen::VectorXd mean = covariance * (seen.transpose() * left);

  Posterior posterior;
  posterior.flows = static_cast<int>(residual.size());
  posterior.misfit = left.norm() / std::sqrt(static_cast<double>(residual.size()));
  posterior.correlation.resize(inputs, inputs);
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const InputEffect& input = given.inputs[static_cast<std::size_t>(i)];
    const double variance = covariance(i, i);
    // Without the own tolerance the precision of this input is less by 1.
    const double by_data = 1 / variance - 1;
    constexpr double rounding = 1e-12;
    posterior.inputs.push_back({input.key, input.value, input.tolerance,
                                mean[i] * input.tolerance / deviations_of_95_percent,
                                std::sqrt(variance) * input.tolerance,
                                by_data > rounding ? input.tolerance / std::sqrt(by_data)
                                                   : std::numeric_limits<double>::infinity()});
    for (Eigen::Index j = 0; j < inputs; ++j)
      posterior.correlation(i, j) = covariance(i, j) / std::sqrt(variance * covariance(j, j));
  }
  const Eigen::MatrixXd ahead = effects(predicted);
  for (Eigen::Index k = 0; k < ahead.rows(); ++k) {
    const Eigen::VectorXd effect = ahead.row(k).transpose();
    posterior.half_width.push_back(deviations_of_95_percent * std::sqrt(effect.dot(covariance * effect)));
    posterior.shift.push_back(effect.dot(mean));
  }
  return posterior;
}

PosteriorEnsemble draw_inputs(const UncertaintyBand& given, const Eigen::VectorXd& measured,
                              const Eigen::VectorXd& deviation, const FlowsOfValues& flows, int count,
                              unsigned seed) {
  const Eigen::MatrixXd seen = deviation.cwiseInverse().asDiagonal() * effects(given);
  const Eigen::Index inputs = seen.cols();
  Eigen::VectorXd stated(inputs), scale(inputs); // value and deviation of every input
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const InputEffect& input = given.inputs[static_cast<std::size_t>(i)];
    stated[i] = input.value;
    scale[i] = input.tolerance / deviations_of_95_percent;
  }
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](Eigen::Index size) {
    Eigen::VectorXd numbers(size);
    for (double& number : numbers) number = normal(random);
    return numbers;
  };

  PosteriorEnsemble ensemble;
  std::vector<Eigen::VectorXd> kept;
  std::vector<double> misfits;
  const std::optional<Eigen::VectorXd> at_stated = flows(stated);
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd prior = draw(inputs);
    const Eigen::VectorXd target = measured + deviation.cwiseProduct(draw(measured.size()));
    const auto answer = at_stated
                            ? fit_draw(prior, target, deviation, seen, *at_stated,
                                       [&](const Eigen::VectorXd& unit) -> std::optional<Eigen::VectorXd> {
                                         return flows(stated + scale.cwiseProduct(unit));
                                       })
                            : std::nullopt;
    if (!answer) {
      ++ensemble.refused;
      continue;
    }
    kept.emplace_back(stated + scale.cwiseProduct(answer->unit));
    misfits.push_back((measured - answer->flows).cwiseQuotient(deviation).norm() /
                      std::sqrt(static_cast<double>(measured.size())));
  }
  ensemble.values.resize(static_cast<Eigen::Index>(kept.size()), inputs);
  for (std::size_t k = 0; k < kept.size(); ++k) ensemble.values.row(static_cast<Eigen::Index>(k)) = kept[k];
  ensemble.misfit =
      Eigen::Map<const Eigen::VectorXd>(misfits.data(), static_cast<Eigen::Index>(misfits.size()));
  return ensemble;
}

} // namespace undula::training
