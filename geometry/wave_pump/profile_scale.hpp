// A pump profile with wider or narrower gaps: the walls move, or the rim of the membrane.
#pragma once

#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

/// The profile with its two kinds of gap multiplied by factors.
///
/// `clearance_scale` multiplies the vertical clearance between the membrane at rest and the flanges, at every
/// radius between the tip and the clamp radius (both included). A flange is what a vertical ray from the
/// membrane's skin meets first; an edge belongs to it when both of its ends in that range do, so that a
/// recess behind a corner (seen from the membrane, but through the corner's gap) stays. The flanges move
/// vertically. Where the stator goes on below the tip radius (its nose), and where the housing does up to
/// its bore, they move as a whole with the flange at the tip radius. All else stays: bores, and walls beyond
/// the clamp radius, where a flange that went on smoothly gets a step. Points are added to the walls at the
/// tip, at the clamp radius and where the membrane's thickness has a corner, so that the factor holds at
/// every radius, not at the points alone; an added point has the line of the one it follows.
///
/// `rim_gap_scale` multiplies the horizontal gap between the membrane's rim and the housing, at its narrowest
/// over the height of the rim, by moving membrane.outer_radius and the last entry of the thickness.
///
/// A factor of 1 leaves its part of the profile untouched, bit for bit. Throws InputError for factors that
/// are not positive, where a flange would move past the end of the wall it adjoins, and where the scaled
/// profile does not pass check_pump_profile.
PumpProfile scale_clearances(const PumpProfile& profile, double clearance_scale, double rim_gap_scale);

/// Vertical distance (cm) from the membrane's skin at rest to the first wall above (`above`) or below it at
/// radius r; infinity where there is none (over the outlet's bore). r: from tip to rim.
double vertical_clearance(const PumpProfile& profile, double r, bool above);

/// Horizontal distance (cm) from the membrane's rim to the housing, at its narrowest over the height of the
/// rim; infinity where there is none.
double rim_gap(const PumpProfile& profile);

} // namespace undula::geometry
