#include "rom/fixed_domain/condense.hpp"

#include <Eigen/LU>
#include <numeric>
#include <vector>

namespace undula::rom {
namespace {

/// Places of a_p in y, and of what is left.
struct Rows {
  std::vector<int> pressure, kept;
};

Rows rows_of(const Operators& full) {
  const int nu = full.velocity_modes, np = full.pressure_modes, nv = full.displacement_modes;
  Rows rows{std::vector<int>(static_cast<std::size_t>(np)), {}};
  std::iota(rows.pressure.begin(), rows.pressure.end(), nu);
  for (int i = 0; i < nu; ++i) rows.kept.push_back(i);
  for (int i = 0; i < nv; ++i) rows.kept.push_back(nu + np + i);
  return rows;
}

} // namespace

Operators condense_pressure(const Operators& full) {
  const int nu = full.velocity_modes, np = full.pressure_modes;
  if (np == 0) return full;
  const auto [pressure, kept] = rows_of(full);
  const bool algebraic = full.mass.middleRows(nu, np).isZero(0) && full.mass.middleCols(nu, np).isZero(0) &&
                         full.imposed_mass.segment(nu, np).isZero(0) &&
                         full.imposed_stiffness.segment(nu, np).isZero(0) &&
                         full.head.segment(nu, np).isZero(0);
  if (!algebraic) return full;
  const Eigen::FullPivLU<Eigen::MatrixXd> factors(full.linear.block(nu, nu, np, np));
  if (!factors.isInvertible()) return full;

  Operators condensed = full;
  condensed.pressure_modes = 0;
  condensed.supremizer_modes = 0; // they are velocity modes like any other now
  const Eigen::MatrixXd response = factors.solve(full.linear(pressure, kept));
  const Eigen::VectorXd imposed_response = factors.solve(Eigen::VectorXd(full.imposed_linear(pressure)));
  const Eigen::MatrixXd force = full.linear(kept, pressure);
  condensed.linear = full.linear(kept, kept) - force * response;
  condensed.imposed_linear = full.imposed_linear(kept) - force * imposed_response;
  condensed.mass = full.mass(kept, kept);
  condensed.imposed_mass = full.imposed_mass(kept);
  condensed.imposed_stiffness = full.imposed_stiffness(kept);
  condensed.head = full.head(kept);
  return condensed;
}

Eigen::MatrixXd recovered_pressure(const Operators& full, const Eigen::MatrixXd& x,
                                   const Eigen::RowVectorXd& imposed_velocity) {
  const int nu = full.velocity_modes, np = full.pressure_modes;
  const auto [pressure, kept] = rows_of(full);
  const Eigen::FullPivLU<Eigen::MatrixXd> factors(full.linear.block(nu, nu, np, np));
  const Eigen::MatrixXd force =
      full.linear(pressure, kept) * x + Eigen::VectorXd(full.imposed_linear(pressure)) * imposed_velocity;
  return -factors.solve(force);
}

} // namespace undula::rom
