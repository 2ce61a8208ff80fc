// What the tolerances of a scene mean for its head-flow curve.
#pragma once

#include <mpi.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fom/scene/scene.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Flows (l/min) of a scene at fixed heads; NaN where the numerics failed.
using FlowsOfScene = std::function<std::vector<double>(const Scene& scene)>;

/// Half width of the interval that holds a normal number with 95 % probability, in standard deviations.
inline constexpr double deviations_of_95_percent = 1.959964;

/// One input with a tolerance, and what its ends change.
struct InputEffect {
  std::string key;
  double value = 0, tolerance = 0; ///< unit of the key
  std::vector<double> up, down;    ///< l/min at every head: flow at value + tolerance, value - tolerance,
                                   ///< minus that of the scene; NaN where it cannot be had
  std::string note;                ///< why a side is missing, else empty
};

/// Bounds that hold the flow with 95 % probability, as far as the tolerances tell; one entry per head, l/min.
/// NaN where the flow of the scene, or both sides of an input, cannot be had.
struct UncertaintyBand {
  std::vector<double> half_width; ///< of the symmetric band
  std::vector<double> low, high;  ///< below and above the flow, >= 0, where the sides differ
  std::vector<InputEffect> inputs;
};

/// Change of the flow at a head by the tolerance of an input, l/min: (up - down) / 2, or of one side where
/// the other is unknown; NaN where both are.
double effect_of_tolerance(const InputEffect& input, std::size_t head);

/// Throws InputError, with what to write, for a scene without tolerances.
void check_tolerances(const Scene& scene);

/// Propagates Scene::tolerances to first order, inputs independent of each other: the half width is the root
/// sum of squares of (up - down) / 2 over the inputs, or of up (down) alone where the other side is out
/// of range or fails; `low` and `high` that of the changes to their side. `nominal`: flows of the
/// scene itself, from the same function. With `part` < 1 the inputs are moved by that part of their
/// tolerances and the changes scaled to the whole: slopes, where the tolerances are too wide for a line.
/// Throws InputError, with what to write, for a scene without tolerances.
///
/// The computations are dealt out over the ranks of `comm`, each to one rank: `flows` must not communicate
/// over `comm`. Where `flows` itself is collective over some ranks, `comm` is MPI_COMM_SELF on all of them.
/// Collective over `comm`; complete on every rank.
UncertaintyBand propagate_tolerances(const Scene& scene, std::span<const double> nominal,
                                     const FlowsOfScene& flows, MPI_Comm comm, double part = 1);

} // namespace undula::training
