// The reduced bases: one per field, by proper orthogonal decomposition in the field's energy inner product.
#pragma once

#include <span>

#include "fom/levels/prepared_scene.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/reduction/pod.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Columns in the natural order of all unknowns, zero outside their field.
struct Bases {
  Eigen::MatrixXd velocity; ///< proper modes first, then the supremizers, if asked for
  Eigen::MatrixXd pressure;
  Eigen::MatrixXd displacement; ///< relative to the holder; vanish where motion is imposed
  int supremizers = 0;          ///< the last so many columns of `velocity`
  double captured_velocity = 0, captured_pressure = 0, captured_displacement = 0; ///< energy, of 1
};

/// Rigid axial unit displacement of all solids: the lifting of the imposed motion.
Eigen::VectorXd imposed_lifting(const Discretisation<2>& disc);

/// Fluid velocity in the kinetic energy (rho u, v); pressure in L2; displacement relative to the holder in
/// the elastic plus kinetic energy at the middle frequency of the box. Snapshots of every run are divided by
/// the run's own norm, so that small strokes count as much as large ones. Sizes by scene.training (0: by
/// energy tolerance).
///
/// With scene.training.pressure_stability = supremizers (Ballarin et al. 2015), for every pressure mode q the
/// velocity s with (s, v)_X = b(v, q) for all v joins the basis, X the symmetric part of viscosity and
/// stabilisation plus inertia at the middle frequency. Otherwise the projected stabilisation alone ties the
/// pressure to the flow, which on the pump is cheaper and no less accurate. Runs with one rank only.
Bases build_bases(const PreparedScene& prepared, const Scene& scene, std::span<const RunRecord> runs);

} // namespace undula::training
