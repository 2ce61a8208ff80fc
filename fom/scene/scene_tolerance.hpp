// Tolerances of a scene's numbers: key = { value = 0.53, tolerance = 0.01 }.
#pragma once

#include <string>
#include <string_view>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Tolerance stated for a key, in its unit; 0 where none is.
double tolerance_of(const Scene& scene, std::string_view key);

/// States a tolerance >= 0 (unit of the key) in place of an earlier one; 0 is the same as none. Keeps
/// Scene::tolerances in the order of the scene table.
void set_tolerance(Scene& scene, const std::string& key, double tolerance);

/// Narrows the tolerance of a real-valued key, if one is stated, to what keeps value -+ tolerance within the
/// key's allowed range, so that the scene can be written and read. Throws InputError as surface_value.
void narrow_tolerance(Scene& scene, const std::string& key);

} // namespace undula::fom
