// Curves that `undula hq --json` printed, drawn again.
#pragma once

#include <filesystem>
#include <span>

#include "apps/apps.hpp"
#include "apps/input/measured_curve.hpp"

namespace undula::apps {

/// Draws every curve of a file that `undula hq --json` printed, with its band or error estimate, the level
/// beside it, and measured samples: the picture of `undula hq --plot`. Returns false, after a warning, where
/// gnuplot is missing. Throws InputError for another file.
bool show_curves(const std::filesystem::path& file, std::span<const MeasuredCurve> measured,
                 const std::filesystem::path& picture);

} // namespace undula::apps
