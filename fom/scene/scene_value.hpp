// Single numbers of a scene by their key, in the unit of the key.
#pragma once

#include <string_view>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Value of the real-valued key `key` ("operating_point.stroke_mm") in its surface unit. Throws InputError
/// for an unknown key and for one that holds no real number, with the nearest one that does.
double surface_value(const Scene& scene, std::string_view key);

/// The scene with one real-valued key set, in its surface unit; a tolerance stated for the key stays as it
/// is. Throws InputError as surface_value, for a value out of the range of the key, and where the scene then
/// contradicts itself (check_consistency).
Scene with_value(const Scene& scene, std::string_view key, double surface_value);

/// Sets the key as with_value does, in a scene that need not be a whole one: what contradicts itself is not
/// refused.
void set_value(Scene& scene, std::string_view key, double surface_value);

/// The number, the shortest in decimals, that times cgs_per_unit gives exactly `stored`, as the parser
/// multiplies; where none exists, the nearest.
double to_surface_unit(double stored, double cgs_per_unit);

} // namespace undula::fom
