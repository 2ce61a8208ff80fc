// The membrane as an annular plate with shear (Mindlin 1951), linear or with von Karman's stretching.
#pragma once

#include <array>
#include <numbers>
#include <type_traits>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Deflection w (axial, cm), rotation theta (dw/dr without shear, rad), radial displacement u (cm) of the
/// mid-plane, or their rates.
template <typename Number>
struct PlateNode {
  Number w, theta, u;
};

/// Stress resultants of one element times their virtual strains: forces on the element's two nodes, dyn (w,
/// u) and dyn cm (theta), and the energy in it.
template <typename Number>
struct PlateForces {
  PlateNode<Number> inner, outer;
  double elastic = 0; ///< erg; only of forces without derivatives
  double damping = 0; ///< dissipation by Kelvin-Voigt damping, erg/s; likewise
};

/// A ring element between two radii.
struct PlateElement {
  double radius = 0;    ///< cm, in the middle
  double length = 0;    ///< cm
  double thickness = 0; ///< cm, in the middle
};

/// Quadratic form of plane stress in the strains a and b.
inline double plane_form(double a, double b, double poisson) { return a * a + b * b + 2 * poisson * a * b; }

/// Internal forces of one linear element, everything at its middle: one point is what keeps a thin plate from
/// locking in shear and stretching. The shear stiffness carries the bending flexibility that linear rotations
/// lack (MacNeal 1978), which makes a beam's nodes exact. Stress = C (strain + damping_time * rate).
///   Strains: theta', theta/r | w' - theta | u' + w'^2/2, u/r (the stretching only for von Karman).
template <typename Number>
PlateForces<Number> plate_forces(const PlateElement& element, const SolidProperties& material,
                                 SolidModel model, const std::array<PlateNode<Number>, 2>& d,
                                 const std::array<PlateNode<Number>, 2>& v) {
  constexpr double shear_correction = 5.0 / 6.0; // Reissner
  const double h = element.thickness, length = element.length, r = element.radius;
  const double nu = material.poisson, plane = material.young / (1 - nu * nu);
  const double bending = plane * h * h * h / 12, stretching = plane * h;
  const double shear_modulus = material.young / (2 * (1 + nu));
  const double shear = 1 / (1 / (shear_correction * shear_modulus * h) + length * length / (12 * bending));
  const double area = 2 * std::numbers::pi * r * length; // of the ring
  const double tau = material.damping_time;

  const auto slope = [&](const Number& inner, const Number& outer) -> Number {
    return (outer - inner) / length;
  };
  const auto mean = [](const Number& inner, const Number& outer) -> Number { return 0.5 * (inner + outer); };
  constexpr bool with_energy = std::is_same_v<Number, double>; // derivatives of energies are not asked for
  struct Strains {
    Number curvature, hoop_curvature, shear, stretch, hoop_stretch;
  };
  const Number w_slope = slope(d[0].w, d[1].w), v_slope = slope(v[0].w, v[1].w);
  Strains strain, rate;
  strain.curvature = slope(d[0].theta, d[1].theta);
  strain.hoop_curvature = mean(d[0].theta, d[1].theta) / r;
  strain.shear = w_slope - mean(d[0].theta, d[1].theta);
  rate.curvature = slope(v[0].theta, v[1].theta);
  rate.hoop_curvature = mean(v[0].theta, v[1].theta) / r;
  rate.shear = v_slope - mean(v[0].theta, v[1].theta);

  const auto with_rate = [&](const Number& e, const Number& e_rate) -> Number { return e + tau * e_rate; };
  const Number kr = with_rate(strain.curvature, rate.curvature);
  const Number kt = with_rate(strain.hoop_curvature, rate.hoop_curvature);
  const Number mr = bending * (kr + nu * kt), mt = bending * (kt + nu * kr);
  const Number q = shear * with_rate(strain.shear, rate.shear);

  PlateForces<Number> f;
  const Number bend = area * mr / length, turn = area * (mt / (2 * r) - 0.5 * q);
  f.inner.theta = turn - bend;
  f.outer.theta = turn + bend;
  Number push = area * q / length;
  f.inner.u = f.outer.u = Number(0.0);
  if constexpr (with_energy) {
    f.elastic = 0.5 * area *
                (bending * plane_form(strain.curvature, strain.hoop_curvature, nu) +
                 shear * strain.shear * strain.shear);
    f.damping =
        area * tau *
        (bending * plane_form(rate.curvature, rate.hoop_curvature, nu) + shear * rate.shear * rate.shear);
  }
  if (model == SolidModel::von_karman) {
    strain.stretch = slope(d[0].u, d[1].u) + 0.5 * w_slope * w_slope;
    strain.hoop_stretch = mean(d[0].u, d[1].u) / r;
    rate.stretch = slope(v[0].u, v[1].u) + w_slope * v_slope;
    rate.hoop_stretch = mean(v[0].u, v[1].u) / r;
    const Number er = with_rate(strain.stretch, rate.stretch);
    const Number et = with_rate(strain.hoop_stretch, rate.hoop_stretch);
    const Number nr = stretching * (er + nu * et), nt = stretching * (et + nu * er);
    f.inner.u = area * (nt / (2 * r) - nr / length);
    f.outer.u = area * (nt / (2 * r) + nr / length);
    push += area * nr * w_slope / length;
    if constexpr (with_energy) {
      f.elastic += 0.5 * area * stretching * plane_form(strain.stretch, strain.hoop_stretch, nu);
      f.damping += area * tau * stretching * plane_form(rate.stretch, rate.hoop_stretch, nu);
    }
  }
  f.inner.w = -push;
  f.outer.w = push;
  return f;
}

} // namespace undula::fom
