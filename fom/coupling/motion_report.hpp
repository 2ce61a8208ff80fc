// What a step of a moving domain did to its geometry.
#pragma once

namespace undula::fom {

/// Of one regular step.
struct MotionReport {
  int parts = 1;                    ///< steps that the regular step was divided into
  int iterations = 1;               ///< turns of placing and solving, the most of all parts
  int new_nodes = 0;                ///< fluid nodes that took their history from the extension
  int contact_nodes = 0;            ///< nodes of the skin in the film of contact
  int solves = 0;                   ///< linear solves, of all parts and turns that were kept
  double film_change = 0;           ///< largest relative change of a gap in the film, of all parts
  int unfolding_iterations = 0;     ///< of the map's correction, the most of all parts; 0: none was needed
  double smallest_volume_ratio = 1; ///< of J of the domain's map
  double placement_error = 0;       ///< cm, largest of the parts between placed and computed displacement
};

} // namespace undula::fom
