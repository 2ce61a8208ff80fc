// A ring pressed flat between two plates: the cross-section of a hose, per unit length.
//
// The wall is an inextensible elastica with the radius a of its middle at rest. While it touches the plates
// at a point each, its curvature there falls from 1/a to 0; below the height of 1.4355 a the touching parts
// lie flat, and the two free sides keep their shape and shrink with the height. With the angle theta of the
// tangent to the plates, P the force per side and B the bending stiffness,
//   B/2 (k^2 - k0^2) = P sin(theta),   height = int sin/k d theta,   pi a = int 1/k d theta   (0 < theta <
//   pi),
// so that in the second part the force is 2 P = 5.742 B / height^2.
#pragma once

namespace undula::fom {

/// Per unit length of the hose.
struct RingResponse {
  double force = 0;  ///< dyn/cm, on either plate
  double energy = 0; ///< erg/cm, from the ring at rest
};

/// A ring of mean radius `a` (cm) and bending stiffness `stiffness` (B = E t^3 / 12 / (1 - nu^2), dyn cm)
/// whose middle lines are `height` (cm, in (0, 2 a]) apart.
RingResponse flattened_ring(double a, double stiffness, double height);

/// The same from a table, for many calls: to 1e-4.
class FlattenedRing {
public:
  FlattenedRing(double a, double stiffness) : a_(a), stiffness_(stiffness) {}
  RingResponse operator()(double height) const;

private:
  double a_ = 0, stiffness_ = 0;
};

} // namespace undula::fom
