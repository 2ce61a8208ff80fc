// A random reduced model with the structure of a projected one: SPD mass, dissipative linear part, a pressure
// saddle point, a membrane coupled by drag, energy-neutral convection.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

struct SyntheticSizes {
  int velocity = 0, pressure = 0, displacement = 0;
};

/// Deterministic for a given seed. `convection` scales the quadratic term (0: a linear model). Rates of decay
/// and of oscillation are spread around 2 pi 100 Hz, so that inertia, viscosity, elasticity and convection
/// all matter.
inline Operators synthetic_operators(const SyntheticSizes& sizes, double convection, unsigned seed = 1) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](int rows, int columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); }));
  };
  const int nu = sizes.velocity, np = sizes.pressure, nv = sizes.displacement, n = nu + np + nv;
  constexpr double rate = 628.0; // 1/s
  Operators o;
  o.velocity_modes = nu;
  o.pressure_modes = np;
  o.displacement_modes = nv;

  const auto spd = [&](int size, double spread) {
    const Eigen::MatrixXd a = random(size, size) / std::sqrt(size);
    return Eigen::MatrixXd(Eigen::MatrixXd::Identity(size, size) + spread * a * a.transpose());
  };
  o.mass = Eigen::MatrixXd::Zero(n, n);
  o.mass.topLeftCorner(nu, nu) = spd(nu, 0.3);
  o.mass.bottomRightCorner(nv, nv) = 0.5 * spd(nv, 0.3);

  o.linear = Eigen::MatrixXd::Zero(n, n);
  const Eigen::VectorXd damping = Eigen::VectorXd::LinSpaced(nu, 0.1, 3.0) * rate; // fine scales decay faster
  o.linear.topLeftCorner(nu, nu) = damping.asDiagonal();
  const Eigen::MatrixXd coupling =
      random(nu + nv, nv) * std::sqrt(rate / (nu + nv)); // drag between fluid and membrane
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(n, nv);
  stacked.topRows(nu) = coupling.topRows(nu);
  stacked.bottomRows(nv) = -coupling.bottomRows(nv);
  o.linear += stacked * stacked.transpose();
  o.linear.bottomRightCorner(nv, nv).diagonal().array() += 0.05 * rate;
  const Eigen::MatrixXd divergence = random(np, nu) / std::sqrt(nu);
  o.linear.block(nu, 0, np, nu) = divergence;
  o.linear.block(0, nu, nu, np) = -divergence.transpose();
  o.linear.block(nu, nu, np, np) = 1e-4 * Eigen::MatrixXd::Identity(np, np);

  const Eigen::MatrixXd modes = random(nv, nv);
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(modes).householderQ();
  const Eigen::VectorXd springs = Eigen::VectorXd::LinSpaced(nv, 0.3, 30.0) * rate * rate;
  o.stiffness = q * springs.asDiagonal() * q.transpose();
  o.stiffness = (0.5 * (o.stiffness + o.stiffness.transpose())).eval();

  for (int k = 0; k < nu; ++k) {
    Eigen::MatrixXd a = random(nu, nu) * convection / nu;
    for (int j = 0; j < nu; ++j) // coupling among higher modes is weaker, as for POD modes of falling energy
      for (int i = 0; i < nu; ++i) a(i, j) /= 1.0 + 0.05 * (i + j + k);
    o.convection.emplace_back(a - a.transpose());
  }
  o.imposed_mass = 0.3 * random(n, 1);
  o.imposed_linear = rate * random(n, 1);
  o.imposed_stiffness = Eigen::VectorXd::Zero(n);
  o.imposed_stiffness.tail(nv) = 0.3 * rate * rate * random(nv, 1);
  o.imposed_mass.segment(nu, np).setZero();
  o.imposed_linear.segment(nu, np) *= 1e-3;
  o.outflow = random(nu, 1);
  for (int i = 0; i < nu; ++i) o.outflow[i] /= 1.0 + i;
  o.inflow = o.outflow;
  o.head = Eigen::VectorXd::Zero(n);
  o.head.head(nu) = o.outflow;
  o.envelope = random(5, nv);
  o.envelope_imposed = Eigen::VectorXd::Ones(5);
  o.envelope_radius = Eigen::VectorXd::LinSpaced(5, 0.5, 2.0);
  return o;
}

} // namespace undula::rom
