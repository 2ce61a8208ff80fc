#include "fom/contact/rigid_gap.hpp"

#include <cmath>
#include <limits>

#include "geometry/mesh/outline_faults.hpp"
#include "geometry/mesh/segments.hpp"

namespace undula::fom {

namespace {

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

template <int dim>
Matrix<dim> rotation(double angle) {
  Matrix<dim> turn = Matrix<dim>::Identity();
  if constexpr (dim == 2) turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return turn;
}

/// 1 - n n^T over a radius.
template <int dim>
Matrix<dim> curvature(const Point<dim>& n, double radius) {
  return (Matrix<dim>::Identity() - n * n.transpose()) / radius;
}

template <int dim>
void away_from_point(const Point<dim>& point, const Point<dim>& x, double sign, RigidGap<dim>& gap) {
  const Point<dim> away = x - point;
  const double radius = away.norm();
  gap.distance = sign * radius;
  gap.direction =
      radius > 0 ? Point<dim>(sign * away / radius) : Point<dim>(sign * Point<dim>::Unit(dim - 1));
  gap.second_derivative =
      sign * curvature<dim>(gap.direction, std::max(radius, std::numeric_limits<double>::min()));
}

/// In the frame of the body at t = 0.
RigidGap<2> gap_to_polygon(const std::vector<Point<2>>& outline, const Point<2>& x) {
  RigidGap<2> gap;
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t side = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double distance = distance_to_segment<2>(outline[i], outline[(i + 1) % outline.size()], x);
    if (distance >= nearest) continue;
    nearest = distance;
    side = i;
  }
  const Point<2>&a = outline[side], &b = outline[(side + 1) % outline.size()];
  const double s = nearest_on_segment<2>(a, b, x);
  if (s > 0 && s < 1) {
    const Point<2> along = (b - a).normalized();
    gap.direction = {along[1], -along[0]};
    gap.distance = (x - a).dot(gap.direction);
    gap.second_derivative.setZero();
  } else {
    away_from_point<2>(s > 0 ? b : a, x, surrounds(outline, x) ? -1 : 1, gap);
  }
  return gap;
}

} // namespace

template <int dim>
RigidPlacement<dim> place_rigid(const RigidBody<dim>& body, double t, double dt) {
  constexpr double part = 1e-3; // of a step: small against what moves within it, large against rounding
  const double h = part * dt;
  RigidPlacement<dim> placement;
  if (body.displacement) {
    placement.displacement = body.displacement(t);
    placement.velocity = (body.displacement(t + h) - body.displacement(t - h)) / (2 * h);
  }
  if (body.angle) {
    placement.angle = body.angle(t);
    placement.rate = (body.angle(t + h) - body.angle(t - h)) / (2 * h);
  }
  return placement;
}

template <int dim>
RigidGap<dim> gap_to_rigid(const RigidBody<dim>& body, const RigidPlacement<dim>& placement,
                           const Point<dim>& x) {
  using Shape = typename RigidBody<dim>::Shape;
  const Matrix<dim> turn = rotation<dim>(placement.angle);
  const Point<dim> at_start = turn.transpose() * (x - placement.displacement - body.about) + body.about;
  RigidGap<dim> gap;
  switch (body.shape) {
    case Shape::ball:
      away_from_point<dim>(body.centre, at_start, body.hollow ? -1 : 1, gap);
      gap.distance += body.hollow ? body.radius : -body.radius;
      break;
    case Shape::half_space:
      gap.direction = body.normal;
      gap.distance = (at_start - body.centre).dot(body.normal);
      gap.second_derivative.setZero();
      break;
    case Shape::polygon:
      if constexpr (dim == 2) gap = gap_to_polygon(body.outline, at_start);
      break;
  }
  gap.direction = turn * gap.direction;
  gap.second_derivative = turn * gap.second_derivative * turn.transpose();
  gap.velocity = placement.velocity;
  if constexpr (dim == 2) {
    const Point<dim> arm = x - placement.displacement - body.about;
    gap.velocity += placement.rate * Point<dim>(-arm[1], arm[0]);
  }
  return gap;
}

template RigidPlacement<2> place_rigid(const RigidBody<2>&, double, double);
template RigidGap<2> gap_to_rigid(const RigidBody<2>&, const RigidPlacement<2>&, const Point<2>&);

} // namespace undula::fom
