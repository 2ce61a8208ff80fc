// A thin plate of uniform thickness at large deflection: the equations of von Karman for an axisymmetric
// load, by Chebyshev collocation and Newton. With phi = w' and N the radial force per length,
//   D (phi'' + phi'/r - phi/r^2) = N phi + p (r^2 - b^2) / (2 r)
//   r^2 N'' + 3 r N' = -(E h / 2) phi^2
// Inner edge b free: phi' + nu phi/r = 0, N = 0 (a disc, b = 0: phi = 0, N' = 0). Outer edge a clamped: phi =
// 0 and no radial displacement, r N' + (1 - nu) N = 0.
#pragma once

#include "tests/verification/support/thin_gap_mindlin.hpp"

namespace undula::verification {

struct VonKarmanPlate {
  double inner = 0, outer = 0, h = 0; ///< cm
  double young = 0, poisson = 0;      ///< dyn/cm^2, -
  int order = 40;                     ///< of the polynomials

  double stiffness() const { return young * h * h * h / (12 * (1 - poisson * poisson)); }

  /// Deflection (cm) of the inner edge (of the centre) under the pressure (dyn/cm^2), reached in steps.
  double deflection(double pressure, int load_steps) const {
    const Eigen::VectorXd r = chebyshev_points(order, inner, outer);
    const Eigen::MatrixXd first = differentiation(r), second = first * first;
    const int n = order + 1;
    Eigen::VectorXd phi = Eigen::VectorXd::Zero(n), N = Eigen::VectorXd::Zero(n);
    for (int step = 1; step <= load_steps; ++step)
      for (int iteration = 0; iteration < 30; ++iteration) {
        Eigen::VectorXd residual(2 * n);
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
        const double p = pressure * step / load_steps, D = stiffness();
        for (int i = 1; i < order; ++i) {
          A.block(i, 0, 1, n) = second.row(i) + first.row(i) / r[i];
          A(i, i) -= 1 / (r[i] * r[i]) + N[i] / D;
          A(i, n + i) = -phi[i] / D;
          residual[i] = (second.row(i) + first.row(i) / r[i]).dot(phi) - phi[i] / (r[i] * r[i]) -
                        N[i] * phi[i] / D - p * (r[i] * r[i] - inner * inner) / (2 * r[i] * D);
          A.block(n + i, n, 1, n) = r[i] * r[i] * second.row(i) + 3 * r[i] * first.row(i);
          A(n + i, i) = young * h * phi[i];
          residual[n + i] = (r[i] * r[i] * second.row(i) + 3 * r[i] * first.row(i)).dot(N) +
                            young * h / 2 * phi[i] * phi[i];
        }
        const auto condition = [&](int row, const Eigen::RowVectorXd& on_phi,
                                   const Eigen::RowVectorXd& on_N) {
          A.block(row, 0, 1, n) = on_phi;
          A.block(row, n, 1, n) = on_N;
          residual[row] = on_phi.dot(phi) + on_N.dot(N);
        };
        const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(n);
        const Eigen::RowVectorXd at_inner = Eigen::RowVectorXd::Unit(n, 0);
        const Eigen::RowVectorXd at_outer = Eigen::RowVectorXd::Unit(n, order);
        if (inner > 0) {
          condition(0, first.row(0) + poisson / inner * at_inner, zero);
          condition(n, zero, at_inner);
        } else {
          condition(0, at_inner, zero);
          condition(n, zero, first.row(0));
        }
        condition(order, at_outer, zero);
        condition(n + order, zero, outer * first.row(order) + (1 - poisson) * at_outer);
        const Eigen::VectorXd update = A.partialPivLu().solve(residual);
        phi -= update.head(n);
        N -= update.tail(n);
        if (update.head(n).lpNorm<Eigen::Infinity>() < 1e-12 * phi.lpNorm<Eigen::Infinity>()) break;
      }
    // w = 0 at the clamp; w' = phi.
    Eigen::MatrixXd A = first;
    A.row(order) = Eigen::RowVectorXd::Unit(n, order);
    Eigen::VectorXd slope = phi;
    slope[order] = 0;
    return A.partialPivLu().solve(slope)[0];
  }
};

} // namespace undula::verification
