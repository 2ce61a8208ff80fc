// Waves in an elastic tube filled with fluid: axisymmetric linear Navier-Stokes flow for r < R, isotropic
// elastodynamics for R < r < R + h, no force on the outer face, everything as exp(i (w t - k z)). The fluid:
// p = I0(k r) with the flow it drives, and a shear mode with kappa^2 = k^2 + i w rho / mu. The wall:
// potentials of dilatation and shear with alpha^2 = k^2 - w^2 rho_s / (lambda + 2 G), beta^2 = k^2 - w^2
// rho_s / G, each with I and K. Velocity and traction agree at r = R.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

namespace undula::verification {

using Complex = std::complex<double>;

struct Tube {
  double radius, thickness, young, poisson, wall_density, density, viscosity, frequency;
};

struct BesselPair {
  Complex zero, one; ///< I0 and I1, or K0 and -K1: in either case the derivative of `zero` is `one`
};

/// Series in x, for |x| up to about 10.
inline BesselPair bessel_i(Complex x) {
  const Complex q = x * x / 4.0;
  Complex zero_term = 1, one_term = x / 2.0, zero = zero_term, one = one_term;
  for (int n = 1; n < 80; ++n) {
    zero_term *= q / double(n * n);
    one_term *= q / double(n * (n + 1));
    zero += zero_term;
    one += one_term;
  }
  return {zero, one};
}
inline BesselPair bessel_k(Complex x) {
  const Complex q = x * x / 4.0, log = std::log(x / 2.0);
  const auto i = bessel_i(x);
  Complex zero_term = 1, one_term = 1, zero = 0, one = 0;
  double harmonic = 0;
  for (int n = 0; n < 80; ++n) {
    if (n > 0) {
      zero_term *= q / double(n * n);
      one_term *= q / double(n * (n + 1));
      harmonic += 1.0 / n;
    }
    zero += zero_term * harmonic;
    one += one_term * (2 * harmonic + 1.0 / (n + 1) - 2 * std::numbers::egamma);
  }
  return {-(log + std::numbers::egamma) * i.zero + zero, -(1.0 / x + log * i.one - x / 4.0 * one)};
}

/// Determinant of the six conditions, 0 where a wave of wave number k exists. Columns are scaled to 1.
inline Complex tube_determinant(const Tube& tube, Complex k) {
  const Complex i(0, 1);
  const double w = 2 * std::numbers::pi * tube.frequency;
  const double shear = tube.young / (2 * (1 + tube.poisson));
  const double lambda = 2 * shear * tube.poisson / (1 - 2 * tube.poisson);
  Eigen::Matrix<Complex, 6, 6> conditions = Eigen::Matrix<Complex, 6, 6>::Zero();
  // A mode u_r = radial * f1(s r), u_z = axial * f0(s r), with f0' = f1 and f1(x)' = f0(x) - f1(x) / x.
  struct Mode {
    Complex u_r, u_z, rr, rz; ///< without the share of a pressure in rr
  };
  const auto mode = [&](const BesselPair& f, Complex s, double r, Complex radial, Complex axial, double mu) {
    const Complex u_r = radial * f.one, u_z = axial * f.zero;
    const Complex dr_u_r = radial * s * (f.zero - f.one / (s * r)), dr_u_z = axial * s * f.one;
    return Mode{u_r, u_z, 2 * mu * dr_u_r, mu * (dr_u_z - i * k * u_r)};
  };
  const double r = tube.radius;
  const auto fluid = [&](int column, Mode m, Complex pressure) {
    conditions.col(column).head<4>() << m.u_r, m.u_z, m.rr - pressure, m.rz;
  };
  const auto in_k = bessel_i(k * r);
  fluid(0, mode(in_k, k, r, i * k / (w * tube.density), k / (w * tube.density), tube.viscosity), in_k.zero);
  const Complex kappa = std::sqrt(k * k + i * w * tube.density / tube.viscosity);
  fluid(1, mode(bessel_i(kappa * r), kappa, r, i * k, kappa, tube.viscosity), 0);
  const Complex alpha = std::sqrt(k * k - w * w * tube.wall_density / (lambda + 2 * shear));
  const Complex beta = std::sqrt(k * k - w * w * tube.wall_density / shear);
  for (const bool second : {false, true}) {
    const auto bessel = [&](Complex x) { return second ? bessel_k(x) : bessel_i(x); };
    for (const bool rotation : {false, true}) {
      const Complex s = rotation ? beta : alpha;
      const int column = 2 + 2 * second + rotation;
      for (const bool outside : {false, true}) {
        const double at = outside ? r + tube.thickness : r;
        const auto f = bessel(s * at);
        auto m = rotation ? mode(f, s, at, i * k, s, shear) : mode(f, s, at, s, -i * k, shear);
        if (!rotation) m.rr += lambda * (s * s - k * k) * f.zero;
        if (outside)
          conditions.col(column).tail<2>() << m.rr, m.rz;
        else
          conditions.col(column).head<4>() << -i * w * m.u_r, -i * w * m.u_z, -m.rr, -m.rz;
      }
    }
  }
  for (int column = 0; column < 6; ++column) conditions.col(column) /= conditions.col(column).norm();
  return conditions.determinant();
}

/// The wave number near `guess`, by the secant method.
inline Complex tube_wave_number(const Tube& tube, Complex guess) {
  Complex before = guess * 1.001, k = guess, value_before = tube_determinant(tube, before);
  for (int step = 0; step < 40; ++step) {
    const Complex value = tube_determinant(tube, k);
    if (value == value_before || std::abs(k - before) < 1e-14 * std::abs(k)) break;
    const Complex next = k - value * (k - before) / (value - value_before);
    before = k;
    value_before = value;
    k = next;
  }
  return k;
}

} // namespace undula::verification
