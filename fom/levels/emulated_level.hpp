// An emulator behind the door.
#pragma once

#include <optional>

#include "fom/levels/level.hpp"
#include "rom/emulator/emulator.hpp"

namespace undula::fom {

class EmulatedLevel final : public Level {
public:
  explicit EmulatedLevel(rom::Emulator emulator) : emulator_(std::move(emulator)) {}

  std::string name() const override { return "emulator"; }
  /// The runs that it interpolates.
  int unknowns() const override;

  /// Values between the runs, with the error of the flow that nine in ten runs are within.
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;

  /// Parameters outside of the box of the runs.
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;

private:
  rom::Emulator emulator_;
};

/// An emulator of a pump that a voltage drives knows other forces per volt too: they scale the voltage.
inline constexpr const char* force_key = "actuator.force_N_per_V";

/// The inputs of an emulator at an operating point: frequency, drive, head; the stroke is the nominal one.
/// Then the further ones: varied keys of the point, the others as stated.
rom::EmulatorPoint emulator_point(const rom::Emulator& emulator, const OperatingPoint& at);

/// The same with the further inputs that a scene states, and the voltage at the force per volt of the runs.
rom::EmulatorPoint emulator_point(const rom::Emulator& emulator, const Scene& scene);

/// What an emulator says of the scene it stands for: operating point, drive, box, force per volt and further
/// inputs alone. The head is the middle of the box. Throws InputError for a missing drive, one of the wrong
/// kind, or numbers that are no operating point.
Scene scene_of_emulator(const rom::Emulator& emulator, const std::string& file, double frequency_Hz,
                        const std::optional<double>& stroke_mm, const std::optional<double>& voltage_V);

/// The keys of a scene that the emulator answers for.
std::vector<std::string> emulated_keys(const rom::Emulator& emulator);

} // namespace undula::fom
