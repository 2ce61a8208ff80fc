// The reduced model of a pump whose fluid's domain moves by a map: modes on the domain at rest, and the few
// elements whose weighted sums stand for all. It carries scene and profile, so that mesh, cut and element
// forms are those of the full order that it was made from.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// One full-order run and what the model makes of its operating point.
struct MovingRun {
  double frequency_Hz = 0, voltage_V = 0, head_mmHg = 0;
  bool held_out = false;
  double flow_l_per_min = 0;           ///< of the full order
  double standard_error_l_per_min = 0; ///< of that mean
  double stroke_mm = 0;
  double fom_seconds = 0;
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double rom_flow_l_per_min = unknown; ///< NaN: the model was not asked, or failed
  double rom_standard_error_l_per_min = unknown;
  double rom_stroke_mm = unknown;
  double rom_seconds = unknown;
};

struct MovingModel {
  std::string scene;                ///< TOML
  std::string profile;              ///< TOML, the pump's
  Eigen::MatrixXd basis;            ///< unknowns x modes, natural order of the scene's discretisation
  int pressure_modes = 0;           ///< the last columns
  std::vector<double> part_weights; ///< by part of the cut, most of them 0; empty: all 1
  std::vector<double> cell_weights; ///< by cell of the solids, the same
  TrainingBox box;                  ///< the voltage, V, in the place of the stroke
  std::vector<MovingRun> runs;
  double error_l_per_min = 0; ///< nine in ten held-out runs are within; infinite: none was held out
  std::map<std::string, std::string> provenance;
};

/// Whether a file says that it holds a model of a moving domain. False for a missing file. Throws
/// InputError for one that is no HDF5 file.
bool holds_moving_model(const std::string& file);

/// Throws InputError for a missing, damaged or foreign file, and for numbers that do not fit together.
MovingModel load_moving_model(const std::string& file);

/// Under a temporary name, then renamed.
void save_moving_model(const MovingModel& model, const std::string& file);

} // namespace undula::rom
