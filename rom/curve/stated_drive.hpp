// What a question says of the drive, beside what the model is driven by.
#pragma once

#include <optional>
#include <string>

namespace undula::rom {

/// One of the two: the amplitude of the holder's stroke, or that of the voltage.
struct StatedDrive {
  std::optional<double> stroke_mm, voltage_V;
};

/// The stroke, mm, or where the model is driven `by_voltage` the voltage, V. Throws InputError where that one
/// is missing, not alone, or no finite number > 0; `model` begins the message ("the emulator"), `where` ends
/// it.
double drive_of(const StatedDrive& stated, bool by_voltage, const std::string& model,
                const std::string& where);

/// A stroke as scenes keep it, in cm, and back: the command line asks models through a scene, and the answers
/// of other callers have to agree with it to the last digit.
double stroke_of_scenes(double stroke_mm);

} // namespace undula::rom
