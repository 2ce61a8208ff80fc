#include "fom/long_wave/flattened_ring.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Integrals over the angle of a free side whose curvature is sqrt(2 P / B) sqrt(m + sin theta): of
/// (m + sin)^-1/2 (its length), sin (m + sin)^-1/2 (its height) and (m + sin)^1/2 (its energy).
struct SideIntegrals {
  double length = 0, height = 0, energy = 0;
};

SideIntegrals side_integrals(double m) {
  // theta = phi - sin(2 phi) / 2: the weight vanishes like sin^2 at the ends, where m = 0 is singular.
  constexpr int points = 400;
  SideIntegrals sum;
  for (int i = 0; i < points; ++i) {
    const double phi = pi * (i + 0.5) / points, theta = phi - 0.5 * std::sin(2 * phi);
    const double weight = (1 - std::cos(2 * phi)) * pi / points, sine = std::sin(theta);
    const double root = std::sqrt(m + sine);
    sum.length += weight / root;
    sum.height += weight * sine / root;
    sum.energy += weight * root;
  }
  return sum;
}

/// The side of parameter m in a ring of mean radius 1 and stiffness 1.
struct UnitRing {
  double height = 0;
  RingResponse response;
};

UnitRing point_contact(double m) {
  const SideIntegrals side = side_integrals(m);
  const double scale = side.length / pi; // sqrt(2 P / B), from the length of the side
  return {side.height / scale, {scale * scale, scale * side.energy - pi}};
}

constexpr UnitRing round_ring = {2, {0, 0}};

/// The ring whose touching parts have just come to lie flat, at a smaller height.
RingResponse shrunk(const UnitRing& flat, double height) {
  const double factor = flat.height / height;
  return {flat.response.force * factor * factor, (flat.response.energy + pi) * factor - pi};
}

/// Rings that touch at points, from the flat height to nearly 2.
std::vector<UnitRing> point_contact_table() {
  constexpr int count = 400;
  constexpr double least = 1e-5, greatest = 1e3;
  std::vector<UnitRing> table = {point_contact(0)};
  for (int i = 0; i < count; ++i)
    table.push_back(point_contact(least * std::pow(greatest / least, static_cast<double>(i) / (count - 1))));
  return table;
}

RingResponse unit_ring(double height) {
  const UnitRing flat = point_contact(0);
  if (height <= flat.height) return shrunk(flat, height);
  // The height grows with m, without bound to 2.
  double low = 0, high = 1;
  while (point_contact(high).height < height && high < 1e12) high *= 4;
  for (int i = 0; i < 100 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (point_contact(middle).height < height ? low : high) = middle;
  }
  return point_contact(0.5 * (low + high)).response;
}

} // namespace

RingResponse flattened_ring(double a, double stiffness, double height) {
  if (height >= 2 * a) return {};
  const RingResponse unit = unit_ring(height / a);
  return {stiffness / (a * a) * unit.force, stiffness / a * unit.energy};
}

RingResponse FlattenedRing::operator()(double height) const {
  static const std::vector<UnitRing> table = point_contact_table();
  const double unit_height = height / a_;
  if (unit_height >= 2) return {};
  const auto scaled = [&](const RingResponse& unit) {
    return RingResponse{stiffness_ / (a_ * a_) * unit.force, stiffness_ / a_ * unit.energy};
  };
  const auto right = std::ranges::upper_bound(table, unit_height, {}, &UnitRing::height);
  if (right == table.begin()) return scaled(shrunk(table.front(), unit_height));
  const UnitRing &low = *(right - 1), &high = right == table.end() ? round_ring : *right;
  const double part = (unit_height - low.height) / (high.height - low.height);
  return scaled({low.response.force + part * (high.response.force - low.response.force),
                 low.response.energy + part * (high.response.energy - low.response.energy)});
}

} // namespace undula::fom
