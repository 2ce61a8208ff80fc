// An annular plate with shear and rotary inertia (Mindlin 1951), inner edge free, outer edge clamped, solved
// by Chebyshev collocation of its differential equations: no finite elements, no lumping.
//
// First-order system in w, theta, M_r, Q (virtual work of D/2 (theta'^2 + ...) + kappa G h/2 (w' - theta)^2):
//   w'     = theta + Q / (kappa G h)
//   theta' = M_r / D - nu theta / r
//   M_r'   = (M_t - M_r) / r - Q - omega^2 rho h^3/12 theta,     M_t = nu M_r + D (1 - nu^2) theta / r
//   Q'     = -Q / r - omega^2 rho h w - p
// M_r = Q = 0 inside, w = theta = 0 outside.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace undula::verification {

/// n + 1 Chebyshev points of the second kind on [low, high], ascending.
inline Eigen::VectorXd chebyshev_points(int n, double low, double high) {
  Eigen::VectorXd x(n + 1);
  for (int i = 0; i <= n; ++i)
    x[i] = 0.5 * (low + high) - 0.5 * (high - low) * std::cos(std::numbers::pi * i / n);
  return x;
}

/// Derivative at the points, from values at them (barycentric weights of the points of the second kind).
inline Eigen::MatrixXd differentiation(const Eigen::VectorXd& x) {
  const auto n = x.size();
  const auto weight = [&](Eigen::Index i) {
    return (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == n - 1 ? 0.5 : 1.0);
  };
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      D(i, j) = weight(j) / weight(i) / (x[i] - x[j]);
      D(i, i) -= D(i, j);
    }
  return D;
}

/// Matrix that interpolates from the points x to the points y, none of which is one of x.
inline Eigen::MatrixXd interpolation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const auto n = x.size();
  Eigen::MatrixXd P(y.size(), n);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      P(i, j) = (j % 2 == 0 ? 1.0 : -1.0) * (j == 0 || j == n - 1 ? 0.5 : 1.0) / (y[i] - x[j]);
    P.row(i) /= P.row(i).sum();
  }
  return P;
}

struct MindlinPlate {
  std::vector<double> radii;               ///< cm, ascending: edges, and where the thickness has corners
  std::function<double(double)> thickness; ///< cm
  double young = 0, poisson = 0;           ///< dyn/cm^2, -
  double density = 0;                      ///< g/cm^3
  int order = 20;                          ///< of the polynomials between two radii

  /// Deflection (cm) of the inner edge under a uniform pressure (dyn/cm^2).
  double deflection(double pressure) const {
    const System system = assemble();
    return system.stiffness.fullPivLu().solve(pressure * system.load)[0];
  }
  /// Lowest angular frequencies, rad/s.
  std::vector<double> frequencies(int count) const {
    const System system = assemble();
    // stiffness y = omega^2 inertia y; the largest eigenvalues 1 / omega^2 of the inverse.
    const Eigen::VectorXcd values =
        Eigen::EigenSolver<Eigen::MatrixXd>(system.stiffness.fullPivLu().solve(system.inertia), false)
            .eigenvalues();
    std::vector<double> real;
    for (const auto& value : values)
      if (value.real() > 0 && std::abs(value.imag()) < 1e-6 * value.real()) real.push_back(value.real());
    std::sort(real.rbegin(), real.rend());
    if (static_cast<int>(real.size()) < count) throw std::runtime_error("too few frequencies");
    std::vector<double> omega;
    for (int k = 0; k < count; ++k) omega.push_back(1 / std::sqrt(real[k]));
    return omega;
  }

private:
  struct System {
    Eigen::MatrixXd stiffness, inertia;
    Eigen::VectorXd load;
  };

  System assemble() const {
    const int parts = static_cast<int>(radii.size()) - 1, block = 4 * (order + 1), n = parts * block;
    System system{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
    auto& A = system.stiffness;
    const double h0 = thickness(radii.back()), D0 = bending(h0); // scale of moments and forces
    const auto at = [&](int part, int field, int point) {
      return part * block + field * (order + 1) + point;
    };
    int row = 0;
    A(row++, at(0, 2, 0)) = 1;
    A(row++, at(0, 3, 0)) = 1;
    A(row++, at(parts - 1, 0, order)) = 1;
    A(row++, at(parts - 1, 1, order)) = 1;
    for (int part = 1; part < parts; ++part)
      for (int field = 0; field < 4; ++field) {
        A(row, at(part - 1, field, order)) = 1;
        A(row++, at(part, field, 0)) = -1;
      }
    for (int part = 0; part < parts; ++part) {
      const Eigen::VectorXd x = chebyshev_points(order, radii[part], radii[part + 1]);
      Eigen::VectorXd y(order); // points of the first kind lie between those of the second
      for (int i = 0; i < order; ++i)
        y[i] = 0.5 * (radii[part] + radii[part + 1]) -
               0.5 * (radii[part + 1] - radii[part]) * std::cos(std::numbers::pi * (i + 0.5) / order);
      const Eigen::MatrixXd P = interpolation(x, y), derivative = P * differentiation(x);
      for (int i = 0; i < order; ++i) {
        const double r = y[i], h = thickness(r), D = bending(h) / D0;
        const double shear = 5.0 / 6 * young / (2 * (1 + poisson)) * h / D0;
        for (int j = 0; j <= order; ++j) {
          const double p = P(i, j), d = derivative(i, j);
          A(row, at(part, 0, j)) += d;
          A(row, at(part, 1, j)) -= p;
          A(row, at(part, 3, j)) -= p / shear;
          A(row + 1, at(part, 1, j)) += d + poisson * p / r;
          A(row + 1, at(part, 2, j)) -= p / D;
          A(row + 2, at(part, 2, j)) += d + (1 - poisson) * p / r;
          A(row + 2, at(part, 1, j)) -= D * (1 - poisson * poisson) * p / (r * r);
          A(row + 2, at(part, 3, j)) += p;
          A(row + 3, at(part, 3, j)) += d + p / r;
          system.inertia(row + 2, at(part, 1, j)) -= density * h * h * h / 12 / D0 * p;
          system.inertia(row + 3, at(part, 0, j)) -= density * h / D0 * p;
        }
        system.load[row + 3] = -1 / D0;
        row += 4;
      }
    }
    return system;
  }
  double bending(double h) const { return young * h * h * h / (12 * (1 - poisson * poisson)); }
};

} // namespace undula::verification
