// A strip of plate between two rigid walls, half a wave long, whose end conditions make cos(kx) exact.
#pragma once

#include <numbers>

#include "fom/problem/default_weights.hpp"
#include "fom/system/operators.hpp"
#include "tests/verification/support/membrane_wave.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {

struct WaveCase {
  MembraneWave wave; ///< layers[0] below, layers[1] above
  int nx = 32, ny = 44;
  double reference_time = 0.01; ///< of the stabilisation, s
};

/// Plate of length 1 cm around y = 0; at x = 0 and x = 1 cm the displacement along x vanishes (sliding) and
/// the fluid is symmetric. The fluid mesh does not know the plate. Linear: no convection.
inline Discretisation<2> wave_discretisation(const WaveCase& scene) {
  const auto& wave = scene.wave;
  FsiProblem<2> problem;
  problem.flow = FlowModel::stokes; // time-dependent: the mass stays
  problem.fluid = {wave.fluid_density, wave.viscosity};
  problem.stabilisation = derived_weights(1.0, scene.reference_time);
  problem.pin_pressure = true;
  problem.background =
      box({0, -wave.layers[0] - wave.h / 2}, {1, wave.layers[1] + wave.h / 2}, scene.nx, scene.ny);
  using Kind = BoundaryCondition<2>::Kind;
  for (const char* name : {"left", "right"}) problem.boundary[name].kind = Kind::symmetry;
  for (const char* name : {"bottom", "top"}) problem.boundary[name].kind = Kind::velocity;
  SolidBody<2> plate;
  plate.mesh = box({0, -wave.h / 2}, {1, wave.h / 2}, scene.nx, 2);
  plate.properties = {wave.solid_density, wave.young, wave.poisson, 0.0};
  problem.solids.push_back(std::move(plate));
  auto disc = discretise(std::move(problem), CutOptions{});
  hold_component(disc, 0, 0, [](const Point<2>& x) { return x[0] == 0 || x[0] == 1; });
  return disc;
}

/// cos(kx) on the plate's velocities.
inline Eigen::VectorXd plate_cosine(const Discretisation<2>& disc, double k) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  const auto& nodes = disc.solid_spaces[0].nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    x[disc.solid_unknown(0, static_cast<int>(i), 1)] = std::cos(k * nodes[i][0]);
  return x;
}

} // namespace undula::verification
