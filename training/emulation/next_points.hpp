// Where an emulator asks for its next runs.
#pragma once

#include <span>
#include <vector>

#include "rom/emulator/emulator.hpp"
#include "training/sampling/plan.hpp"

namespace undula::training {

struct NextPoints {
  std::vector<OperatingPoint> points; ///< in the order in which they are wanted
  double largest_error = 0;           ///< l/min, stated by the emulator as it is, over the candidates
};

/// `count` points of a dense scrambled Halton set in the box where the stated error of the mean flow is
/// largest. Each takes into account what the runs before it will tell of its surroundings (the process with a
/// value put in at its mean). The same on every machine. None of `asked`, also where its run failed.
NextPoints next_points(const rom::Emulator& emulator, const Scene& scene,
                       std::span<const OperatingPoint> asked, int count);

} // namespace undula::training
