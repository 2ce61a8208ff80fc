// A hose between rollers and the track that they press it against: where it is squeezed, and how far.
//
// The track's wall is an arc concentric with the rotor, continued by straight tangents. Under a roller the
// bore is h(s) = gap + s^2 / (2 r) high, s along the centreline from the roller and r the relative radius of
// roller and pressing face. On a tangent the same parabola is lifted by how far the roller is from it.
#pragma once

namespace undula::geometry {

/// Lengths in cm, angles in rad.
struct RollerTrack {
  double bore_radius = 0;  ///< a
  double wall = 0;         ///< thickness of the hose's wall
  double track_radius = 0; ///< of the track's wall
  double track_angle = 0;  ///< of the arc
  double roller_radius = 0;
  int rollers = 0;
  double gap = 0; ///< height of the bore under a roller on the arc, in (0, 2 a)
};

/// Radius of the hose's centreline, track_radius - wall - bore_radius.
double centreline_radius(const RollerTrack& track);

/// Radius of the face that a roller presses to, track_radius - 2 wall - gap.
double pressing_radius(const RollerTrack& track);

/// Distance of a roller's axis from that of the rotor.
double crank(const RollerTrack& track);

/// r: 1 / r = 1 / roller_radius - 1 / pressing_radius.
double relative_radius(const RollerTrack& track);

/// Half the length that a roller squeezes where the bore under it is `gap` high: sqrt(2 r (2 a - gap)).
double half_reach(const RollerTrack& track, double gap);

/// Volume that the bore misses under a roller: (16/15) pi a^2 (1 - gap / 2a)^2 half_reach, cm^3.
double missing_volume(const RollerTrack& track, double gap);

/// Height of the bore under a roller at `angle` from the begin of the arc, at most 2 a (released), and its
/// derivative by the angle.
struct GapAtAngle {
  double gap = 0;   ///< cm
  double slope = 0; ///< cm/rad
};
GapAtAngle gap_at(const RollerTrack& track, double angle);

/// Angle beyond the arc at which a roller has released the hose.
double release_angle(const RollerTrack& track);

/// Greatest distance along the centreline, beyond the arc, at which a roller still squeezes the hose.
double outer_reach(const RollerTrack& track);

/// Volume per turn of a hose that is closed under a roller at all times, cm^3:
/// 2 pi R pi a^2 - rollers * missing_volume(gap).
double closed_volume_per_turn(const RollerTrack& track);

} // namespace undula::geometry
