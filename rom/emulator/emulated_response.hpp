// What a pump does over a period, interpolated from runs: the course of the membrane, the outflow.
//
// Runs at different points share most of their course. Its mean over the runs is kept, and the few modes that
// hold most of the rest (proper orthogonal decomposition over the runs); the coefficient of each mode is a
// Gaussian process of the inputs. As Guo & Hesthaven, Comput. Methods Appl. Mech. Engrg. 341 (2018) 807.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rom/emulator/gaussian_process.hpp"

namespace undula::rom {

struct Emulator;

/// A value per input of an emulator; without the further ones, they are as stated.
using EmulatorPoint = std::vector<double>;

/// Values at places and phases. A value at place i of n and phase k is entry k * n + i of mean and modes.
struct EmulatedResponse {
  std::string name, unit;
  std::vector<double> places_mm; ///< radius of each place; a single 0 where the quantity is one of the pump
  int phases = 0;                ///< even over a period; the first one at its begin, by the drive's sine
  Eigen::VectorXd mean;
  Eigen::MatrixXd modes;                     ///< orthonormal columns
  std::vector<GaussianProcess> coefficients; ///< by mode, unit of the values
  /// What the root mean square difference of nine in ten runs, each left out, is within; unit of the values.
  double error = 0;
};

struct PeriodResponse {
  Eigen::MatrixXd values; ///< [place][phase]
  double error = 0;       ///< EmulatedResponse::error, larger outside of the box as growth_outside
};

/// The course over a period at a point. Its coefficients follow the emulator's inputs.
PeriodResponse emulate(const Emulator& emulator, const EmulatedResponse& response,
                       const EmulatorPoint& point);

/// The response of a name, or null.
const EmulatedResponse* find_response(const Emulator& emulator, const std::string& name);

/// Axial displacement of the membrane's mid-plane, and flow out of the pump: names and units.
inline constexpr const char* membrane_response = "membrane_mm";
inline constexpr const char* outflow_response = "outflow_l_per_min";

} // namespace undula::rom
