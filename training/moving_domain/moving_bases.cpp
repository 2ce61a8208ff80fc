#include "training/moving_domain/moving_bases.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fom/time/time_stepper.hpp"
#include "rom/base/error.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/reduction/inner_products.hpp"
#include "training/reduction/pod.hpp"

namespace undula::training {
namespace {

/// Snapshots that a decomposition takes at most: its cost goes with their square.
constexpr Eigen::Index most_snapshots = 800;

/// Columns of a run that are used, evenly spread.
std::vector<Eigen::Index> chosen_snapshots(std::span<const RunRecord> runs, const RunRecord& run) {
  Eigen::Index all = 0;
  for (const auto& each : runs) all += static_cast<Eigen::Index>(each.times.size());
  const Eigen::Index stride = (all + most_snapshots - 1) / most_snapshots;
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(run.times.size()); k += stride) chosen.push_back(k);
  return chosen;
}

template <class ValuesAt>
Eigen::MatrixXd gather(std::span<const RunRecord> runs, ValuesAt&& values_at) {
  std::vector<Eigen::VectorXd> columns;
  for (const auto& run : runs)
    for (const Eigen::Index k : chosen_snapshots(runs, run)) columns.push_back(values_at(run, k));
  Eigen::MatrixXd all(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
}

double energy(const SparseMatrix& mass, const Eigen::MatrixXd& columns, int first, int count) {
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  part.middleRows(first, count) = columns.middleRows(first, count);
  return part.cwiseProduct(mass * part).sum();
}

/// Mass in which the snapshots' fluid and solids have the energy 1 each.
SparseMatrix balanced_mass(const Discretisation<2>& disc, const SparseMatrix& mass,
                           const Eigen::MatrixXd& velocities) {
  const int fluid = disc.fluid_unknowns(), solid = disc.solid_unknowns();
  Eigen::VectorXd scale(disc.unknowns());
  scale.head(fluid).setConstant(1 / std::sqrt(energy(mass, velocities, 0, fluid)));
  scale.tail(solid).setConstant(1 / std::sqrt(energy(mass, velocities, fluid, solid)));
  return scale.asDiagonal() * mass * scale.asDiagonal();
}

/// The fluid's equations of a step from rest, without convection.
class FluidAtRest {
public:
  FluidAtRest(const PreparedScene& prepared, double time_step) : disc_(prepared.disc) {
    const double by_time = bdf_coefficients(TimeScheme::bdf2, 2)[0] / time_step;
    const auto& operators = prepared.operators;
    SparseMatrix sum = operators.physical + operators.stabilisation;
    matrix_ = sum + by_time * operators.mass;
    std::vector<int> all(static_cast<std::size_t>(disc_.fluid_unknowns()));
    std::iota(all.begin(), all.end(), 0);
    factor(all, whole_);
    factor(velocity_unknowns(disc_), velocities_);
  }

  /// Velocity of the fluid, on top of the solids' in `moved`, that their motion drives.
  Eigen::VectorXd lifted(const Eigen::VectorXd& moved) const {
    Eigen::VectorXd all = moved + expanded(whole_, -(matrix_ * moved));
    all(pressure_unknowns(disc_)).setZero();
    return all;
  }

  /// Velocity that a pressure drives.
  Eigen::VectorXd supremizer(const Eigen::VectorXd& pressure) const {
    return expanded(velocities_, matrix_ * pressure);
  }

private:
  struct Block {
    std::vector<int> free;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factors;
  };

  void factor(const std::vector<int>& unknowns, Block& block) {
    for (const int unknown : unknowns)
      if (!disc_.is_constrained[static_cast<std::size_t>(unknown)]) block.free.push_back(unknown);
    block.factors.compute(submatrix(matrix_, block.free));
    if (block.factors.info() != Eigen::Success)
      throw NumericsError("the fluid's equations at rest could not be factored", "training",
                          "larger Nitsche and ghost penalties (section [stabilisation])");
  }

  Eigen::VectorXd expanded(const Block& block, const Eigen::VectorXd& forces) const {
    const Eigen::VectorXd right = forces(block.free);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(disc_.unknowns());
    const Eigen::VectorXd solved = block.factors.solve(right); // needs its rows side by side
    all(block.free) = solved;
    return all;
  }

  const Discretisation<2>& disc_;
  SparseMatrix matrix_;
  Block whole_, velocities_;
};

/// Adds to the orthonormal `columns` what the others have besides; what depends on them is left out.
int extend_basis(const SparseMatrix& inner, const Eigen::MatrixXd& others,
                 std::vector<Eigen::VectorXd>& columns) {
  constexpr double dependent = 1e-6;
  int added = 0;
  for (Eigen::Index k = 0; k < others.cols(); ++k) {
    Eigen::VectorXd column = others.col(k);
    const double before = std::sqrt(column.dot(inner * column));
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd weighted = inner * column;
      Eigen::VectorXd along(static_cast<Eigen::Index>(columns.size()));
      for (std::size_t j = 0; j < columns.size(); ++j)
        along[static_cast<Eigen::Index>(j)] = columns[j].dot(weighted);
      for (std::size_t j = 0; j < columns.size(); ++j)
        column -= along[static_cast<Eigen::Index>(j)] * columns[j];
    }
    const double left = std::sqrt(column.dot(inner * column));
    if (!(left > dependent * before)) continue;
    columns.push_back(column / left);
    ++added;
  }
  return added;
}

void require_still_boundaries(const Discretisation<2>& disc, const Eigen::MatrixXd& basis) {
  const std::vector<int>& joined = disc.joined;
  for (int unknown = 0; unknown < disc.unknowns(); ++unknown) {
    if (!disc.is_constrained[static_cast<std::size_t>(unknown)] || std::ranges::count(joined, unknown) > 0)
      continue;
    // Iterative solutions leave a little in rows that say zero.
    if (basis.row(unknown).cwiseAbs().maxCoeff() > 1e-4 * basis.cwiseAbs().maxCoeff())
      throw InputError("modes of a moving domain vanish where the boundary imposes a value",
                       "an imposed motion of unknown " + std::to_string(unknown),
                       "walls at rest, and a holder driven by a voltage", "section [operating_point]");
  }
}

} // namespace

MovingBases build_moving_bases(const PreparedScene& prepared, const Scene& scene,
                               std::span<const RunRecord> runs) {
  const auto& disc = prepared.disc;
  const auto& plan = scene.training;
  const auto pressures = pressure_unknowns(disc);
  const auto options = [&](int modes) { return PodOptions{modes, modes > 0 ? 0.0 : plan.energy_tolerance}; };
  const auto velocities = gather(runs, [&](const RunRecord& run, Eigen::Index k) {
    Eigen::VectorXd x = unknowns_at(disc, run, k);
    x(pressures).setZero();
    return x;
  });
  const SparseMatrix inner = balanced_mass(disc, prepared.operators.mass, velocities);
  const auto velocity = pod(velocities, Eigen::SparseMatrix<double>(inner), options(plan.velocity_modes));
  const auto displacements =
      gather(runs, [&](const RunRecord& run, Eigen::Index k) { return displacements_at(disc, run, k); });
  const auto displacement =
      pod(displacements, Eigen::SparseMatrix<double>(inner), options(plan.displacement_modes));

  const SparseMatrix pressure_inner = pressure_product(prepared);
  const auto pressure = pod(gather(runs,
                                   [&](const RunRecord& run, Eigen::Index k) {
                                     Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
                                     x(pressures) = run.snapshots.at(pressure_field).values.col(k);
                                     return x;
                                   }),
                            Eigen::SparseMatrix<double>(pressure_inner), options(plan.pressure_modes));

  // The constant conserves the fluid's volume as a whole, whatever the other modes do.
  std::vector<Eigen::VectorXd> pressure_columns;
  Eigen::MatrixXd constant = Eigen::MatrixXd::Zero(disc.unknowns(), 1);
  constant(pressures, 0).setOnes();
  extend_basis(pressure_inner, constant, pressure_columns);
  extend_basis(pressure_inner, pressure.modes, pressure_columns);
  Eigen::MatrixXd pressure_modes(disc.unknowns(), static_cast<Eigen::Index>(pressure_columns.size()));
  for (std::size_t k = 0; k < pressure_columns.size(); ++k)
    pressure_modes.col(static_cast<Eigen::Index>(k)) = pressure_columns[k];

  const double middle = (plan.frequency_low + plan.frequency_high) / 2;
  const FluidAtRest fluid(prepared, 1 / (middle * scene.time.steps_per_period));
  Eigen::MatrixXd lifted(disc.unknowns(), displacement.modes.cols()),
      supremizers(disc.unknowns(), pressure_modes.cols());
  for (Eigen::Index k = 0; k < lifted.cols(); ++k) lifted.col(k) = fluid.lifted(displacement.modes.col(k));
  for (Eigen::Index k = 0; k < supremizers.cols(); ++k)
    supremizers.col(k) = fluid.supremizer(pressure_modes.col(k));

  MovingBases bases;
  std::vector<Eigen::VectorXd> columns;
  bases.velocity = extend_basis(inner, velocity.modes, columns);
  bases.lifted = extend_basis(inner, lifted, columns);
  bases.supremizers = extend_basis(inner, supremizers, columns);
  bases.pressure = static_cast<int>(pressure_modes.cols());
  bases.basis.resize(disc.unknowns(), static_cast<Eigen::Index>(columns.size()) + bases.pressure);
  for (std::size_t k = 0; k < columns.size(); ++k) bases.basis.col(static_cast<Eigen::Index>(k)) = columns[k];
  bases.basis.rightCols(bases.pressure) = pressure_modes;
  require_still_boundaries(disc, bases.basis);
  for (int unknown = 0; unknown < disc.unknowns(); ++unknown)
    if (disc.is_constrained[static_cast<std::size_t>(unknown)] &&
        std::ranges::count(disc.joined, unknown) == 0)
      bases.basis.row(unknown).setZero();
  bases.captured_velocity = velocity.captured_energy;
  bases.captured_displacement = displacement.captured_energy;
  bases.captured_pressure = pressure.captured_energy;
  return bases;
}

} // namespace undula::training
