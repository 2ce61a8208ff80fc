// Where in the box of operating points the full-order model is run: for training, and for judging.
#pragma once

#include <span>
#include <vector>

#include "fom/scene/scene.hpp"
#include "training/sampling/varied_keys.hpp"
#include "training/training.hpp"

namespace undula::training {

struct SamplingPlan {
  std::vector<OperatingPoint> training; ///< corners of the box first, then the space-filling interior points
  std::vector<OperatingPoint> held_out; ///< never trained on; strictly inside the box
};

/// Lays out the points of `box`, the same on every machine. What drives, and what else a point states, is
/// that of `like`.
///
/// Training: the corners of the operating points, with the varied keys as stated, then the first
/// `training_points` of a Halton sequence with scrambled digits; a larger count keeps the earlier points, so
/// that a campaign can be extended. Held out: chosen one after the other from a dense scrambled Halton set in
/// the middle 80 % of every range, each as far as possible from all training and held-out points before it.
/// In the box scaled to the unit cube of its d ranges of positive width (those of varied keys among them),
/// the distance of a held-out point to every other point is at least 0.3 n^(-1/d), n the number of all
/// points.
///
/// A range of zero width is a fixed value; with d = 0 there is one training point and nothing may be held
/// out. Throws InputError for a range with low > high, a negative count, or points in a box without width.
SamplingPlan plan_samples(const TrainingPlan& box, const OperatingPoint& like = {},
                          std::span<const VariedKey> varied = {});

/// Whether a point lies in the box, its faces included, and varies no other keys.
bool is_inside(const TrainingPlan& box, const OperatingPoint& point, std::span<const VariedKey> varied = {});

/// Points of a dense scrambled Halton set over the whole box, for who looks for the best of them; the same on
/// every machine, and none of `plan_samples`. Throws as that does.
std::vector<OperatingPoint> candidate_points(const TrainingPlan& box, const OperatingPoint& like = {},
                                             std::span<const VariedKey> varied = {});

} // namespace undula::training
