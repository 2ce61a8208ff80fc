// What acts on the skins of solids besides a fluid: loads, and contact with rigid bodies and other skins.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fom/problem/fields.hpp"

namespace undula::fom {

/// A load on a part of a solid's skin.
template <int dim>
struct SkinLoad {
  int solid = -1;
  std::function<bool(const Point<dim>&)> where; ///< of places at rest; empty: all of the skin
  ScalarField<dim> pressure; ///< dyn/cm^2 by place at rest, on the skin where it is, against its normal
  VectorField<dim> traction; ///< dyn/cm^2 of skin at rest, by place at rest; keeps its direction
};

/// A rigid body in place at t = 0, and how it moves: turned about `about` by `angle`, then displaced.
template <int dim>
struct RigidBody {
  enum class Shape {
    ball,       ///< `centre`, `radius`; in axisymmetric space about the axis a ball, else a torus
    half_space, ///< `centre` on its face, `normal` out of the material
    polygon     ///< `outline`, the material on its left; plane and axisymmetric space
  };
  std::string name;
  Shape shape = Shape::ball;
  Point<dim> centre = Point<dim>::Zero();         ///< cm
  double radius = 0;                              ///< cm
  Point<dim> normal = Point<dim>::Zero();         ///< unit
  std::vector<Point<dim>> outline;                ///< cm
  bool hollow = false;                            ///< of a ball: the material is outside of it
  std::function<Point<dim>(double)> displacement; ///< cm, empty: none
  TimeFunction angle;                             ///< rad, counter-clockwise, empty: none; plane space
  Point<dim> about = Point<dim>::Zero();          ///< cm
};

/// Two skins, or a skin and a rigid body, that may touch. Where they are nearer than `film` they press on
/// each other by stiffness * (film - gap) per area at rest; friction is Coulomb's, with a creep.
struct ContactPair {
  std::string name;
  int solid = -1;
  int other_solid = -1; ///< the same: a skin that may touch itself
  int rigid = -1;       ///< in FsiProblem::rigid; exactly one of the two is not -1
  double film = 0;      ///< cm
  double stiffness = 0; ///< dyn/cm^3
  double deepest = 0;   ///< cm, a step that goes deeper into the film fails
  double friction = 0;  ///< Coulomb's coefficient
  double creep = 0;     ///< cm/s, > 0 with friction: slip speed at which 0.71 of the limit is reached
};

} // namespace undula::fom
