// The reduced model: dense operators projected from the full-order model, and what is known about its trust.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace undula::rom {

/// Reduced semi-discrete system. With y = [a_u; a_p; a_v] (sizes nu, np, nv; N = nu + np + nv), solid
/// displacement coefficients a_d (same basis as a_v, d(a_d)/dt = a_v), imposed displacement D(t) and velocity
/// V(t) = dD/dt of the holder (cm, cm/s) and head P(t) (dyn/cm^2):
///
///   M dy/dt + K y + [0; 0; S a_d] + [C(a_u) a_u; 0; 0] + m V'(t) + k V(t) + s D(t) + g P(t) = 0,
///   C(b)_ij = sum_k convection[k](i, j) b_k,  skew: a . C(b) a = 0.
///
/// cgs units with velocity coefficients in cm/s of basis vectors normalised in the energy inner product.
struct Operators {
  int velocity_modes = 0; ///< nu, supremizers included
  int supremizer_modes =
      0;                  ///< the last so many of the nu; one per pressure mode, in their order, or none (0)
  int pressure_modes = 0; ///< np
  int displacement_modes = 0; ///< nv
  Eigen::MatrixXd mass;       ///< M, N x N
  Eigen::MatrixXd linear;    ///< K, N x N: viscosity, pressure, divergence, interface, stabilisation, damping
  Eigen::MatrixXd stiffness; ///< S, nv x nv
  std::vector<Eigen::MatrixXd> convection; ///< nu matrices, nu x nu
  Eigen::VectorXd imposed_mass;            ///< m, N
  Eigen::VectorXd imposed_linear;          ///< k, N
  Eigen::VectorXd imposed_stiffness;       ///< s, N
  Eigen::VectorXd head;                    ///< g, N
  Eigen::VectorXd outflow;                 ///< nu: flow out of the outlet = outflow . a_u, cm^3/s
  Eigen::VectorXd inflow;                  ///< nu: flow into the inlet = inflow . a_u, cm^3/s
  Eigen::MatrixXd envelope; ///< n_probe x nv: axial displacement at the probes = envelope a_d + imposed D
  Eigen::VectorXd envelope_imposed; ///< n_probe
  Eigen::VectorXd envelope_radius;  ///< n_probe: r of the probes on the membrane's mid-plane, cm
};

/// Box of trained parameters, surface units.
struct TrainingBox {
  double frequency_low_Hz = 0, frequency_high_Hz = 0;
  double stroke_low_mm = 0, stroke_high_mm = 0;
  double head_low_mmHg = 0, head_high_mmHg = 0;
};

/// One full-order run kept with the model (training or held out) for plots, calibration and checks.
struct ReferencePoint {
  double frequency_Hz = 0, stroke_mm = 0, head_mmHg = 0;
  double flow_l_per_min = 0;        ///< mean over the last period
  double flow_spread_l_per_min = 0; ///< max - min of the last periods' means
  bool held_out = false;
  double rom_flow_l_per_min = 0; ///< of this model
  double velocity_error = 0;     ///< relative L2 over a period, ROM against FOM
  double envelope_error = 0;     ///< relative, ROM against FOM
  double fom_seconds = 0;        ///< wall time of the run
};

struct Model {
  Operators operators;
  int steps_per_period = 0; ///< of BDF2 in training; the reduced model uses the same
  TrainingBox box;
  std::vector<ReferencePoint> references;
  /// Error estimate: held-out |flow error| is bounded by safety * indicator + floor (see error_estimate.hpp).
  double error_safety = 0;
  double error_floor_l_per_min = 0;
  std::map<std::string, std::string> provenance; ///< scene text, version, commit, ranks, date
  bool sealed = true; ///< false: read from a file of format 1, whose numbers nothing vouches for
};

/// Keeps the first modes of each field; no re-projection is needed (the operators are nested).
/// `velocity_modes` is without supremizers: those of the pressure modes that stay are kept on top. Throws
/// InputError for more modes than there are.
Operators restrict_operators(const Operators& operators, int velocity_modes, int pressure_modes,
                             int displacement_modes);

/// Reads a model file (HDF5). Throws InputError for a missing, damaged or foreign file, for operators of
/// sizes that do not fit together, for numbers that are not finite, and for a box or an error estimate that
/// cannot be one.
Model load_model(const std::string& file);
/// Writes a model file (under a temporary name, then renamed). The keys of the provenance must not contain
/// '/'. Throws InputError for what load_model would refuse.
void save_model(const Model& model, const std::string& file);

} // namespace undula::rom
