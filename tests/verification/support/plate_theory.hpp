// Kirchhoff theory of a round plate, inner edge free (or none: a disc), outer edge clamped.
#pragma once

#include <Eigen/LU>
#include <cmath>

namespace undula::verification {

/// Radii, thickness in cm; modulus in dyn/cm^2; density in g/cm^3. inner = 0: a disc.
struct PlateTheory {
  double inner, outer, h, young, poisson, density;

  double stiffness() const { return young * h * h * h / (12 * (1 - poisson * poisson)); }

  /// Deflection (cm) at r under a uniform pressure q: w = q r^4 / (64 D) + c1 + c2 ln r + c3 r^2 + c4 r^2 ln
  /// r with w = w' = 0 outside, M_r = Q_r = 0 inside (Timoshenko & Woinowsky-Krieger, chapter 3).
  double deflection(double r, double q) const {
    const double D = stiffness(), a = outer, b = inner;
    if (b == 0) return q * std::pow(a * a - r * r, 2) / (64 * D);
    const auto bending = [&](double first, double second) { return second + poisson * first / b; };
    Eigen::Matrix4d A;
    A << 1, std::log(a), a * a, a * a * std::log(a), //
        0, 1 / a, 2 * a, a * (2 * std::log(a) + 1),  //
        0, bending(1 / b, -1 / (b * b)), bending(2 * b, 2),
        bending(b * (2 * std::log(b) + 1), 2 * std::log(b) + 3), //
        0, 0, 0, 4 / b;
    Eigen::Vector4d load(std::pow(a, 4), 4 * std::pow(a, 3), bending(4 * std::pow(b, 3), 12 * b * b), 32 * b);
    const Eigen::Vector4d c = A.partialPivLu().solve(-q / (64 * D) * load);
    return q * std::pow(r, 4) / (64 * D) + c[0] + c[1] * std::log(r) + c[2] * r * r +
           c[3] * r * r * std::log(r);
  }

  /// Additional deflection by shear (cm), Q / (kappa G h) integrated from the clamp, kappa = 5/6 (Reissner).
  double shear_deflection(double r, double q) const {
    const double shear = 5.0 / 6 * young / (2 * (1 + poisson)) * h;
    const double b = inner, a = outer;
    const double ring = b > 0 ? b * b / 2 * std::log(a / r) : 0.0;
    return q / shear * ((a * a - r * r) / 4 - ring);
  }

  /// First axisymmetric angular frequency, rad/s: the smallest zero of the determinant of the edge conditions
  /// for w = c1 J0(kr) + c2 I0(kr) + c3 Y0(kr) + c4 K0(kr), omega = k^2 sqrt(D / (rho h)).
  double first_omega() const {
    double k = 0.5 / outer;
    while (determinant(k) * determinant(k + 0.01 / outer) > 0) k += 0.01 / outer;
    double low = k, high = k + 0.01 / outer;
    for (int i = 0; i < 60; ++i)
      (determinant(low) * determinant(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return low * low * std::sqrt(stiffness() / (density * h));
  }

private:
  double determinant(double k) const {
    const auto J = [](int n, double z) { return std::cyl_bessel_j(n, z); };
    const auto Y = [](int n, double z) { return std::cyl_neumann(n, z); };
    const auto I = [](int n, double z) { return std::cyl_bessel_i(n, z); };
    const auto K = [](int n, double z) { return std::cyl_bessel_k(n, z); };
    const double a = k * outer, b = k * inner;
    if (inner == 0) return J(0, a) * I(1, a) + I(0, a) * J(1, a);
    // Rows: w, w'/k at the outer edge; M_r and Q_r, up to factors, at the inner one. The Laplacian of J0 and
    // Y0 is -k^2 times, of I0 and K0 +k^2 times the function, and M_r ~ lap w - (1 - nu) w'/r.
    const double c = (1 - poisson) / b;
    Eigen::Matrix4d A;
    A << J(0, a), I(0, a), Y(0, a), K(0, a),                                                          //
        -J(1, a), I(1, a), -Y(1, a), -K(1, a),                                                        //
        -J(0, b) + c * J(1, b), I(0, b) - c * I(1, b), -Y(0, b) + c * Y(1, b), K(0, b) + c * K(1, b), //
        J(1, b), I(1, b), Y(1, b), -K(1, b);
    return A.determinant();
  }
};

} // namespace undula::verification
