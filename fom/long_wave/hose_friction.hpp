// Wall friction of the flow along a hose whose bore is round, or pressed flat.
#pragma once

#include <cmath>
#include <numbers>

#include "geometry/hose/flattened_bore.hpp"

namespace undula::fom {

/// Laminar conductance G = viscosity Q / (-dp/ds), cm^4, of a bore of open radius `a` at height `h`: plane
/// Poiseuille flow over the flat part, and the two round ends. Exact for an open bore and for a thin film;
/// between them the share of the ends is fitted to numerical solutions of the developed flow, to 0.5 %.
inline double flattened_conductance(double a, double h) {
  constexpr double ends_of_slot = 0.01744, ends_of_circle = std::numbers::pi / 128;
  const double open = h / (2 * a), open2 = open * open;
  const double ends = ends_of_slot + (ends_of_circle - ends_of_slot) * open2 * open2 * open;
  return (geometry::flattened_width(a, h) / 12 + ends * h) * h * h * h;
}

/// Friction of a steady flow at a Reynolds number, as a multiple of the laminar one: Churchill's formula for
/// smooth pipes (Chemical Engineering 84 (24), 1977, 91-92), which is 64/Re, Blasius' law and what lies
/// between. Reynolds numbers of the hydraulic diameter.
inline double turbulent_factor(double reynolds) {
  constexpr double laminar_below = 1000; // there the formula is laminar to the last digit
  if (reynolds < laminar_below) return 1;
  const double a = std::pow(2.457 * std::log(std::pow(reynolds / 7, 0.9)), 16);
  const double b = std::pow(37530 / reynolds, 16);
  const double factor = 8 * std::pow(std::pow(8 / reynolds, 12) + std::pow(a + b, -1.5), 1.0 / 12);
  return factor * reynolds / 64;
}

} // namespace undula::fom
