// Mean flow, powers, stroke and clearance of a pump over a box of operating points, interpolated from runs of
// another level: answers in microseconds, each with an error.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "rom/emulator/emulated_response.hpp"
#include "rom/emulator/gaussian_process.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// A range of a number that was varied, surface units. A range without width is a fixed value.
struct EmulatorInput {
  std::string name, unit; ///< of further inputs: the key of the scene and its unit
  double low = 0, high = 0;
  double stated = 0; ///< of further inputs: the scene's own value, taken where none is asked for
};

/// The inputs of an operating point: frequency, drive, head, in this order. Further ones come after them.
inline constexpr std::size_t point_inputs = 3;

struct EmulatedQuantity {
  std::string name, unit;
  GaussianProcess process; ///< over the inputs that have a width, scaled to the unit interval
  /// Stated error over the process's deviation: what holds for nine in ten of the runs, each left out.
  double error_factor = 1;
};

/// One run that the emulator knows, and what it says of it when it does not.
struct EmulatorRun {
  EmulatorPoint point;
  double flow_l_per_min = 0, standard_error_l_per_min = 0;   ///< 0: periodic
  bool held_out = false;                                     ///< in no process
  double emulated_l_per_min = 0, stated_error_l_per_min = 0; ///< left out
  double seconds = 0;
};

struct Emulator {
  bool driven_by_voltage = false; ///< the drive is an amplitude in V, else a stroke in mm
  double force_N_per_V = 0;       ///< of the actuator that a voltage drives; 0: not known
  std::vector<EmulatorInput> inputs;
  std::vector<EmulatedQuantity> quantities; ///< the mean outflow, l/min, first
  std::vector<EmulatedResponse> responses;  ///< empty where the runs recorded no fields
  std::vector<EmulatorRun> runs;
  std::map<std::string, std::string> provenance; ///< as of Model
};

struct EmulatedValue {
  double value = 0;
  double error = 0; ///< what nine in ten are within; infinite far outside of the box
};

struct EmulatedPoint {
  std::vector<EmulatedValue> values; ///< by Emulator::quantities
  bool inside_training_box = false;
};

/// The box of its operating points; the drive, mm or V, in the place of the stroke.
TrainingBox training_box(const Emulator& emulator);

/// The inputs beside those of an operating point.
std::span<const EmulatorInput> further_inputs(const Emulator& emulator);

/// What the emulator says of one point. Outside of the box errors grow as growth_outside.
EmulatedPoint emulate(const Emulator& emulator, const EmulatorPoint& point);

/// Factor on stated errors: 1 inside of the box, see growth_outside.
double growth_at(const Emulator& emulator, const EmulatorPoint& point);

/// The coordinates of a point in an emulator's processes.
Eigen::VectorXd scaled_point(const Emulator& emulator, const EmulatorPoint& point);

/// Reads an emulator (HDF5). Throws InputError for a missing, damaged or foreign file and for contents that
/// make no emulator.
Emulator load_emulator(const std::string& file);

/// Writes it under a temporary name, then renames it.
void save_emulator(const Emulator& emulator, const std::string& file);

/// Whether a file says of itself that it holds an emulator. Throws InputError where it cannot be read.
bool holds_emulator(const std::string& file);

} // namespace undula::rom
