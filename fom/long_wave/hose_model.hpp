// A peristaltic pump as long-wave flow along its hose: the fast level of that machine (docs/peristaltic.md).
//
//   hose_model.hpp      what the scene states, and where the rollers are at a time
//   squeezed_place.hpp  one place under a roller: samples of bore, flow and friction along it
//   hose_flow.hpp       the equation of the flow, and a step of it
//   hose_pressures.hpp  pressures along the hose, and what they do to the rollers
//   hose_picture.hpp    the squeezed hose, to be drawn
//
// The bore follows the rollers (geometry/hose/roller_track.hpp) and opens at once behind them. Continuity
// then leaves one unknown, the flow out of the outlet: Q(s) = outflow + int_s^L dA/dt ds. The momentum of the
// fluid along the hose says what it is.
#pragma once

#include <optional>
#include <vector>

#include "fom/long_wave/flattened_ring.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/hose/roller_track.hpp"

namespace undula::fom {

/// In cgs.
struct HoseModel {
  geometry::RollerTrack track;
  HoseSettings hose;
  FluidProperties fluid;
  double length = 0;                 ///< of the centreline, inlet to outlet
  double area = 0;                   ///< of the open bore
  std::optional<FlattenedRing> ring; ///< nothing where the modulus of the wall is not stated
};

/// A piece of hose under a roller.
struct PressedPlace {
  int roller = 0;
  double position = 0; ///< cm, of the roller along the centreline, from the inlet
  double speed = 0;    ///< cm/s, of that position
  double gap = 0;      ///< cm, height of the bore under the roller
  double closing = 0;  ///< cm/s, rate of the gap
};

HoseModel hose_model(const Scene& scene);

/// Angle of a roller from the begin of the track, in [0, 2 pi).
double roller_angle(const HoseModel& model, double frequency, double time, int roller);

/// Places that rollers squeeze at a time, from the inlet to the outlet.
std::vector<PressedPlace> pressed_places(const HoseModel& model, double frequency, double time);

/// Places along the centreline (cm from the inlet) between which rollers squeeze the hose.
double first_pressed(const HoseModel& model);
double last_pressed(const HoseModel& model);

} // namespace undula::fom
