#include "training/study/sensitivity.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>

namespace undula::training {
namespace {

double variance(const Eigen::VectorXd& values) { return (values.array() - values.mean()).square().mean(); }

/// A term of the polynomial: constant (no key), linear or square in a key, or the product of two.
struct Term {
  int first = -1, second = -1; ///< equal: the square
};

std::vector<Term> terms_of(const Eigen::MatrixXd& x) {
  std::vector<Term> terms = {{}};
  const int keys = static_cast<int>(x.cols());
  for (int i = 0; i < keys; ++i) {
    terms.push_back({i, -1});
    const Eigen::VectorXd column = x.col(i);
    if (std::set<double>(column.begin(), column.end()).size() > 2) terms.push_back({i, i});
    for (int k = 0; k < i; ++k) terms.push_back({k, i});
  }
  return terms;
}

/// Orthonormal over the box with an even density.
double value_of(const Term& term, const Eigen::MatrixXd& x, Eigen::Index run) {
  static const double root3 = std::sqrt(3.0), root5 = std::sqrt(5.0);
  if (term.first < 0) return 1;
  const double a = x(run, term.first);
  if (term.second < 0) return root3 * a;
  if (term.second == term.first) return root5 * 0.5 * (3 * a * a - 1);
  return 3 * a * x(run, term.second);
}

void add_linear(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, Sensitivities& result) {
  Eigen::MatrixXd design(x.rows(), x.cols() + 1);
  design << Eigen::VectorXd::Ones(x.rows()), x;
  const Eigen::VectorXd fit = design.colPivHouseholderQr().solve(y);
  result.linear = 1 - (y - design * fit).squaredNorm() / (static_cast<double>(y.size()) * variance(y));
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    result.keys[static_cast<std::size_t>(i)].standardised =
        fit[i + 1] * std::sqrt(variance(x.col(i)) / variance(y));
}

void add_polynomial(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, Sensitivities& result) {
  const auto terms = terms_of(x);
  const auto count = static_cast<Eigen::Index>(terms.size());
  if (y.size() < 2 * count) return;
  Eigen::MatrixXd design(y.size(), count);
  for (Eigen::Index run = 0; run < y.size(); ++run)
    for (Eigen::Index term = 0; term < count; ++term)
      design(run, term) = value_of(terms[static_cast<std::size_t>(term)], x, run);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < count) return; // the plan does not tell the terms apart
  const Eigen::VectorXd fit = qr.solve(y);

  // Each run left out in turn: its error is the residual over what its own weight leaves.
  const Eigen::MatrixXd thin = qr.householderQ() * Eigen::MatrixXd::Identity(y.size(), count);
  const Eigen::VectorXd residual = y - design * fit;
  double error = 0;
  for (Eigen::Index run = 0; run < y.size(); ++run) {
    const double one = residual[run] / std::max(1 - thin.row(run).squaredNorm(), 1e-12);
    error += one * one;
  }
  result.left_out = 1 - error / (static_cast<double>(y.size()) * variance(y));

  const double all = fit.tail(count - 1).squaredNorm();
  if (!(all > 0)) return;
  result.mean = fit[0];
  for (auto& key : result.keys) key.first_order = key.total = 0;
  for (Eigen::Index i = 1; i < count; ++i) {
    const Term& term = terms[static_cast<std::size_t>(i)];
    const double part = fit[i] * fit[i] / all;
    KeySensitivity& first = result.keys[static_cast<std::size_t>(term.first)];
    first.total += part;
    if (term.second < 0 || term.second == term.first) {
      first.first_order += part;
      (term.second < 0 ? first.slope : first.bend) = fit[i] * std::sqrt(term.second < 0 ? 3.0 : 5.0);
    } else {
      result.keys[static_cast<std::size_t>(term.second)].total += part;
    }
  }
}

} // namespace

Sensitivities sensitivities(const std::vector<std::string>& keys, const Eigen::MatrixXd& x,
                            const Eigen::VectorXd& y) {
  Sensitivities result;
  result.runs = static_cast<int>(y.size());
  if (y.size() == 0) return result;
  result.mean = y.mean();
  // Rounding is no effect.
  const bool changes = std::sqrt(variance(y)) > 1e-12 * y.cwiseAbs().maxCoeff();
  if (!changes || y.size() < x.cols() + 2) return result;
  for (const std::string& key : keys) {
    result.keys.emplace_back();
    result.keys.back().key = key;
  }
  add_linear(x, y, result);
  add_polynomial(x, y, result);
  return result;
}

} // namespace undula::training
