// The meridian profile of a pump: walls, membrane and magnet as polylines in the (r, z) half-plane.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// A polyline of a profile and where its points stand in the file.
struct ProfileCurve {
  std::string key;              ///< "housing.profile", for messages
  std::vector<Point<2>> points; ///< (r, z), cm
  std::vector<int> lines;       ///< line of each point in the file; empty if built in code
};

/// Membrane at rest: a ring of varying thickness, symmetric about a plane z = mid_plane.
struct MembraneProfile {
  double inner_radius = 0; ///< cm, of the tip
  double outer_radius = 0; ///< cm, of the rim
  double clamp_radius = 0; ///< cm, the motion is imposed for r >= clamp_radius
  double mid_plane = 0;    ///< z, cm
  double tip_radius = 0;   ///< cm, of the corners of the tip; 0: sharp
  double rim_radius = 0;   ///< cm, of the corners of the rim; 0: sharp
  ProfileCurve thickness;  ///< (r, thickness), cm; linear between, from inner_radius to outer_radius
  int line = 0;            ///< of the table in the file
};

/// A number that a profile file states beside the geometry: of [materials]. Scenes state their own, which
/// count; these are for comparison.
struct ProfileStatement {
  std::string key;  ///< "materials.fluid.density"
  double value = 0; ///< cgs
  int line = 0;
};

/// What a profile file describes. z = const at the inlet and the outlet; r = 0 is the axis of symmetry.
struct PumpProfile {
  std::filesystem::path file; ///< empty if built in code
  ProfileCurve housing;       ///< outer wall from the inlet rim (top) to the outlet rim (bottom), r > 0
  ProfileCurve stator;        ///< inner wall from the axis (top) to the axis (bottom); ends at r = 0
  MembraneProfile membrane;
  ProfileCurve magnet; ///< closed polygon of either orientation, last point not repeated
  std::vector<ProfileStatement> materials;
};

/// Thickness of the membrane at radius r (held constant beyond its ends), cm.
double membrane_thickness(const MembraneProfile& membrane, double r);

/// The fluid domain without the solids: a closed polygon, counter-clockwise, from the inlet's centre along
/// the axis, the stator, the axis, the outlet, the housing upwards and the inlet. `curves[i]` says what the
/// edge from point i to point i + 1 belongs to.
struct FluidOutline {
  enum Curve { housing = 0, stator = 1, axis = 2, inlet = 3, outlet = 4 };
  std::vector<Point<2>> points; ///< cm
  std::vector<Curve> curves;
  std::vector<int> lines; ///< of the point each edge starts from, 0 if unknown
};
FluidOutline fluid_outline(const PumpProfile& profile);

/// Checks a profile with exact predicates on the given coordinates. Throws InputError (with file and line)
/// when a curve has too few points, a negative radius, points beyond 1e4 cm, crosses itself or another curve,
/// when a solid touches a wall, leaves the fluid domain or overlaps the other solid, when walls or solids are
/// narrower somewhere than `narrowest_part` of the profile's extent, or when thickness or clamp radius make
/// no sense.
void check_pump_profile(const PumpProfile& profile);

/// Reads and checks a profile (TOML, lengths in cm; see data/profiles/wave_pump_profile.toml).
/// [materials], [operating_point] and [published] may be left out; [materials] is kept for comparison with a
/// scene, the others are for readers of the file. Throws InputError for a missing or malformed file, missing,
/// unknown or mistyped keys, materials that make no sense, and all that check_pump_profile finds.
PumpProfile read_pump_profile(const std::filesystem::path& file);

} // namespace undula::geometry
