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

} // namespace undula::rom
