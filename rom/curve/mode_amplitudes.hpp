// The periodic state of a projected model as amplitudes of its modes over time.
#pragma once

#include <Eigen/Core>

#include "rom/curve/hq_curve.hpp"

namespace undula::rom {

/// n_t instants t = 0, T / n_t, ...; a field is the sum of its modes times these.
struct ModeAmplitudes {
  Eigen::VectorXd time_s;       ///< n_t
  Eigen::MatrixXd velocity;     ///< nu x n_t: of the fluid
  Eigen::MatrixXd pressure;     ///< np x n_t
  Eigen::MatrixXd displacement; ///< nv x n_t: of the solids, relative to the holder
  Eigen::VectorXd holder_cm;    ///< n_t: stroke * sin(2 pi t / T)
  bool periodic = false;        ///< false: the last period of a march that does not repeat
};

/// The state behind pump_period. The solver knows no pressure; it is recovered from the rows of K that hold
/// no time derivative. Throws InputError as check_operating_point, NumericsError where the model has no
/// finite state.
ModeAmplitudes mode_amplitudes(const Model& model, double frequency_Hz, double stroke_mm, double head_mmHg,
                               const HqOptions& options = {});

} // namespace undula::rom
