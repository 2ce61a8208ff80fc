// From the runs of a campaign to an emulator of the pump.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rom/emulator/emulated_quantities.hpp"
#include "rom/emulator/emulator.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/sampling/plan.hpp"

namespace undula::training {

/// How well an emulator says what it was not told, by the mean flow.
struct EmulatorScore {
  int runs = 0;
  double rms = 0, worst = 0;  ///< |emulated - run|, l/min
  double covered = 0;         ///< part of the runs within their stated error
  double error_over_true = 0; ///< stated over true error, median
};

/// How well it says the course over a period.
struct ResponseScore {
  std::string name;
  int modes = 0;
  double left_out = 0;                        ///< norm of all differences over that of all runs
  double held_out = 0;                        ///< the same of runs that no mode has seen; 0: none
  double envelope = 0, envelope_held_out = 0; ///< the same of least and largest value at every place
};

struct BuiltEmulator {
  rom::Emulator emulator;
  EmulatorScore left_out; ///< every training run from all others
  EmulatorScore held_out; ///< runs that no process has seen; runs = 0: none
  double flow_range = 0;  ///< l/min, of all runs
  std::vector<ResponseScore> responses;
  std::vector<std::string> not_used; ///< runs that failed or whose mean is not known, and why
};

/// A process per quantity of `columns`, the mean flow first, that all used training runs
/// know. The standard error of a mean flow that does not repeat is the noise of its value. What an error has
/// to be multiplied by to cover nine in ten runs comes from leaving each out. Throws InputError for too few
/// runs that can be used.
BuiltEmulator build_emulator(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                             std::span<const rom::EmulatedColumn> columns = rom::emulated_columns);

} // namespace undula::training
