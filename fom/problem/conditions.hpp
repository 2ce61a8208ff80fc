// In which space a problem lives, what its fluid obeys and what holds at its openings.
#pragma once

namespace undula::fom {

enum class Space { plane, axisymmetric, thin_gap, long_wave };

enum class FlowModel { stokes, navier_stokes };

enum class OpeningCondition {
  total_pressure,  ///< sigma n = -p n + rho/2 (u.n) u: energy-neutral, safe against in- and backflow
  static_pressure, ///< the same on inflow only; plain traction on outflow
  traction,        ///< plain traction on both; for verification, blows up on strong inflow
};

} // namespace undula::fom
