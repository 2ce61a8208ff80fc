#include "fom/machines/peristaltic_pump/hose_remarks.hpp"

#include <cmath>
#include <numbers>

#include "fom/scene/hose_checks.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Three digits are enough for a sentence.
std::string rounded(double value) {
  if (value == 0) return "0";
  const double scale = std::pow(10, 2 - std::floor(std::log10(std::abs(value))));
  return plain_number(std::round(value * scale) / scale);
}

} // namespace

std::vector<std::string> hose_remarks(const Scene& scene) {
  const geometry::RollerTrack track = roller_track(scene);
  const double bore = scene.hose.bore, radius = geometry::centreline_radius(track);
  std::vector<std::string> remarks;
  const double spacing = 2 * pi / track.rollers;
  if (spacing > track.track_angle)
    remarks.push_back("no roller is fully on the track for " +
                      rounded(100 * (spacing - track.track_angle) / spacing) +
                      " % of the time: rollers are " + rounded(spacing * 180 / pi) +
                      " degrees apart, the track is " + rounded(track.track_angle * 180 / pi) + " degrees");
  if (const double slope = std::sqrt(2 * bore / geometry::relative_radius(track)); slope > 0.5)
    remarks.push_back("the squeezed place is short: the bore opens with slopes up to " + rounded(slope) +
                      ", and the long-wave flow asks for slopes well below 1");
  constexpr double beam = 0.2; // thickness over radius up to which a ring counts as thin
  if (const double thickness = scene.hose.wall / (bore / 2 + scene.hose.wall / 2);
      scene.hose.young > 0 && thickness > beam)
    remarks.push_back("the wall is " + rounded(thickness) +
                      " of its radius thick: forces on the rollers are those of a thin ring, extrapolated");
  // Womersley's number of the pulses, n per turn.
  const double pulse = 2 * pi * scene.operating_point.frequency * track.rollers;
  if (const double womersley = bore / 2 * std::sqrt(pulse * scene.fluid.density / scene.fluid.viscosity);
      womersley > 5)
    remarks.push_back("Womersley's number of the pulses is " + rounded(womersley) +
                      ": friction in the open bore is that of a steady flow, and too small in the pulses");
  if (bore > 0.5 * radius)
    remarks.push_back("the bore is " + rounded(bore / radius) +
                      " of the centreline's radius: the flow along a bend is that of a straight hose");
  return remarks;
}

} // namespace undula::fom
