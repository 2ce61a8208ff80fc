// Dispersion relation of a bending wave on a plate between two rigid walls, with viscous fluid layers.
//
// Plane strain, all fields ~ exp(s t), deflection w = W cos(kx) exp(st). In a layer of height H above the
// plate the linearised Navier-Stokes equations have the stream function Psi(y) sin(kx) with
//   u_x = Psi' sin(kx), u_y = -k Psi cos(kx),   Psi = potential part (e^{+-ky}) + vortical part (e^{+-my}),
//   m^2 = k^2 + rho s / mu,   p = rho s / k * (potential part)' cos(kx).
// Conditions: Psi = Psi' = 0 at the wall (no slip); at the plate, whose upper skin lies h/2 above its
// mid-plane and turns with it, -k Psi = s W and Psi' = k h/2 s W. By virtual work the layer loads the plate
// with
//   F = (-P - 2 mu k Psi') + k h/2 mu (Psi'' + k^2 Psi)        per unit of s W: the impedance Z(s).
// For mu -> 0, Z -> -rho s / (k tanh(kH)): the added mass. The plate (Mindlin, kappa = 5/6, with rotary
// inertia):
//   rho_s h (1 + k^2 h^2/12) s^2 + D k^4 / (1 + D k^2 / (kappa G h)) = s sum of Z(s).
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

namespace undula::verification {

struct MembraneWave {
  double wave_number = 0;                  ///< k, 1/cm
  double h = 0;                            ///< thickness, cm
  double young = 0, poisson = 0;           ///< dyn/cm^2, -
  double solid_density = 0;                ///< g/cm^3
  double fluid_density = 0, viscosity = 0; ///< g/cm^3, g/(cm s)
  std::vector<double> layers;              ///< heights of the confined layers, cm

  using Complex = std::complex<double>;

  double bending() const {
    const double k = wave_number, D = young * h * h * h / (12 * (1 - poisson * poisson));
    const double shear = 5.0 / 6 * young / (2 * (1 + poisson)) * h;
    return D * std::pow(k, 4) / (1 + D * k * k / shear);
  }
  double inertia() const { return solid_density * h * (1 + std::pow(wave_number * h, 2) / 12); }

  /// Angular frequency without viscosity, rad/s.
  double inviscid_omega() const {
    double mass = inertia();
    for (const double H : layers) mass += fluid_density / (wave_number * std::tanh(wave_number * H));
    return std::sqrt(bending() / mass);
  }

  /// Load on the plate per velocity of its mid-plane by a layer of height H, g/(cm^2 s).
  Complex impedance(Complex s, double H) const {
    const double k = wave_number;
    const Complex m = std::sqrt(k * k + fluid_density * s / viscosity);
    // Psi = c0 e^{-ky} + c1 e^{k(y-H)} + c2 e^{-my} + c3 e^{m(y-H)}: no exponential exceeds one.
    const double ek = std::exp(-k * H);
    const Complex em = std::exp(-m * H);
    Eigen::Matrix4cd A;
    A << 1, ek, 1, em,          // Psi at the plate
        -k, k * ek, -m, m * em, // Psi' at the plate
        ek, 1, em, 1,           // Psi at the wall
        -k * ek, k, -m * em, m; // Psi' at the wall
    const Eigen::Vector4cd c = A.partialPivLu().solve(Eigen::Vector4cd(-1 / k, k * h / 2, 0, 0));
    const Complex potential_slope = -k * c[0] + k * ek * c[1];
    const Complex value = c[0] + ek * c[1] + c[2] + em * c[3];
    const Complex slope = potential_slope - m * c[2] + m * em * c[3];
    const Complex curvature = k * k * (c[0] + ek * c[1]) + m * m * (c[2] + em * c[3]);
    const Complex pressure = fluid_density * s / k * potential_slope;
    return (-pressure - 2 * viscosity * k * slope) + k * h / 2 * viscosity * (curvature + k * k * value);
  }

  /// Eigenvalue s = -decay + i omega, 1/s, by the secant method from the inviscid one.
  Complex eigenvalue() const {
    const auto residual = [&](Complex s) {
      Complex sum = inertia() * s * s + bending();
      for (const double H : layers) sum -= s * impedance(s, H);
      return sum;
    };
    Complex before(0, inviscid_omega()), s = before * Complex(0.99, 0.05);
    Complex at_before = residual(before);
    for (int iteration = 0; iteration < 100; ++iteration) {
      const Complex at = residual(s), step = at * (s - before) / (at - at_before);
      before = s;
      at_before = at;
      s -= step;
      if (std::abs(step) < 1e-12 * std::abs(s)) return s;
    }
    throw std::runtime_error("the dispersion relation has no root near the inviscid frequency");
  }
};

} // namespace undula::verification
