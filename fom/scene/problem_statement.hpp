// A plane or axisymmetric fluid-structure problem as a scene states it: domain, bodies, conditions and what
// is observed, by name. Plain data in cgs units; expressions stay text (see scene/expression.hpp) in the
// surface units of their keys.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace undula::fom {

/// (x, y), in axisymmetric space (r, z), cm.
using Position = std::array<double, 2>;

/// A polygon, or a circle where `radius` is positive (then `outline` is empty).
struct ShapeStatement {
  std::vector<Position> outline; ///< corners in either direction
  Position centre{};
  double radius = 0;       ///< cm
  double inner_radius = 0; ///< cm; > 0: an annulus
};

/// The fluid's domain without its holes. An empty shape: solids in vacuo.
struct DomainStatement {
  ShapeStatement shape;
  std::vector<std::string> sides; ///< name of the side from each corner to the next; a circle has one
  double size = 0;                ///< cm, largest element size of the fluid
  double growth = 0;              ///< increase of the size per unit distance from where it is refined
};

/// Whether there is a fluid; otherwise solids in vacuo.
inline bool has_fluid(const DomainStatement& domain) {
  return !domain.shape.outline.empty() || domain.shape.radius > 0;
}

/// A hole of the domain. Its edge is a boundary with the name of the hole.
struct HoleStatement {
  ShapeStatement shape;
};

struct BoundaryStatement {
  enum class Kind { wall, velocity, symmetry, opening };
  enum class Stress { total_pressure, static_pressure, traction };
  enum class Tangential { zero, free };
  Kind kind = Kind::wall;
  std::array<std::string, 2> velocity; ///< cm/s
  std::string pressure;                ///< mmHg
  Stress stress = Stress::total_pressure;
  Tangential tangential = Tangential::zero; ///< velocity along an opening
  double size = 0;                          ///< cm, element size of the fluid at this boundary; 0: no demand
};

struct BodyStatement {
  enum class Law { linear, saint_venant_kirchhoff, neo_hookean };
  ShapeStatement shape;
  std::vector<Position> line; ///< corners of a line that the body's mesh keeps as edges
  double size = 0;            ///< cm, of the body's mesh
  double fluid_size = 0;      ///< cm, of the fluid at the body's skin; 0: no demand
  Law law = Law::linear;
  double density = 0;                      ///< g/cm^3
  double young = 0;                        ///< dyn/cm^2
  double poisson = 0;                      ///< -
  double damping_time = 0;                 ///< s
  double mass_damping = 0;                 ///< 1/s
  double stiffness_damping = 0;            ///< s
  std::string held;                        ///< not 0 where the displacement is imposed
  std::array<std::string, 2> displacement; ///< mm, imposed where `held`
  std::array<std::string, 2> body_force;   ///< dyn/cm^3
  std::array<std::string, 2> velocity;     ///< cm/s, at t = 0
};

/// A box in which elements are small: those of a body, or of the fluid.
struct RefinementStatement {
  std::string body;          ///< "" : the fluid
  std::vector<Position> box; ///< lowest and highest corner
  double size = 0;           ///< cm
};

/// A load on the skin of a body.
struct LoadStatement {
  std::string on;
  std::string where;                   ///< not 0 where it acts, at rest; "": all of the skin
  std::string pressure;                ///< mmHg
  std::array<std::string, 2> traction; ///< dyn/cm^2
};

/// A rigid body: a shape, or all that lies on the right of a line.
struct RigidStatement {
  ShapeStatement shape;
  std::vector<Position> line;              ///< two points
  bool hollow = false;                     ///< of a circle: the material is outside
  std::array<std::string, 2> displacement; ///< mm
  std::string angle;                       ///< degrees
  std::vector<Position> about;             ///< one point; none: centre of the circle, or the origin
};

/// Two bodies that may touch.
struct PairStatement {
  std::vector<std::string> between; ///< two names; twice the same: a body that may touch itself
  double film = 0;                  ///< cm
  double stiffness = 0;             ///< dyn/cm^3; 0: derived
  double deepest = 0;               ///< cm; 0: derived
  double friction = 0;              ///< -
  double creep = 0;                 ///< cm/s
};

/// A point that is followed: of a body (displacement), or of the fluid (pressure, velocity).
struct PointStatement {
  std::string body; ///< "" : the fluid
  Position at{};
};

/// A force of the fluid on bodies and boundaries together.
struct ForceStatement {
  std::vector<std::string> on;
};

struct ProblemStatement {
  bool general = false; ///< a domain and bodies of its own; false: the scene is a pump
  std::map<std::string, double> constants;
  DomainStatement domain;
  std::array<std::string, 2> body_force; ///< on the fluid, dyn/cm^3
  std::map<std::string, HoleStatement> holes;
  std::map<std::string, BoundaryStatement> boundaries;
  std::map<std::string, BodyStatement> bodies;
  std::map<std::string, RefinementStatement> refinements;
  std::map<std::string, LoadStatement> loads;
  std::map<std::string, RigidStatement> rigid;
  std::map<std::string, PairStatement> pairs;
  std::map<std::string, PointStatement> points;
  std::map<std::string, ForceStatement> forces;
};

} // namespace undula::fom
