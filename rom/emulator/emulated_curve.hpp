// The curve of an emulator in the form that all levels give.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "rom/curve/curve_point.hpp"
#include "rom/emulator/emulator.hpp"

namespace undula::rom {

/// Values between the runs, in the order of the heads, with the error of the flow that nine in ten runs are
/// within. `drive`: stroke in mm or voltage in V. `on_point` after every point; what it throws ends the
/// curve. `further`: a value per further input; none: as stated. Throws InputError for a frequency or drive
/// that is not positive, and for a head that is not finite.
std::vector<CurvePoint> emulated_curve(const Emulator& emulator, double frequency_Hz, double drive,
                                       std::span<const double> heads_mmHg,
                                       const std::function<void()>& on_point = {},
                                       std::span<const double> further = {});

/// outside_training_box of an emulator's own drive and further inputs.
std::vector<std::string> outside_training_box(const Emulator& emulator, double frequency_Hz, double drive,
                                              std::span<const double> heads_mmHg,
                                              std::span<const double> further = {});

} // namespace undula::rom
