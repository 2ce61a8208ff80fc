#include "training/reduction/bases.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "fom/scene/operating_point.hpp"
#include "rom/base/error.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/reduction/inner_products.hpp"
#include "training/training.hpp"

namespace undula::training {

namespace {

Eigen::MatrixXd expand(const Eigen::MatrixXd& modes, const std::vector<int>& unknowns, int size) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size, modes.cols());
  full(unknowns, Eigen::all) = modes;
  return full;
}

/// Snapshots of one field of all runs side by side, every run divided by its norm in `inner`.
Eigen::MatrixXd gather(std::span<const RunRecord> runs, const char* field, const ColumnSparse& inner,
                       const std::function<void(const RunRecord&, Eigen::MatrixXd&)>& subtract) {
  Eigen::Index columns = 0;
  for (const auto& run : runs) columns += run.snapshots.at(field).values.cols();
  Eigen::MatrixXd all(inner.rows(), columns);
  Eigen::Index next = 0;
  for (const auto& run : runs) {
    Eigen::MatrixXd values = run.snapshots.at(field).values;
    if (subtract) subtract(run, values);
    const double norm =
        std::sqrt((values.transpose() * (inner * values)).trace() / static_cast<double>(values.cols()));
    if (norm > 0) values /= norm;
    all.middleCols(next, values.cols()) = values;
    next += values.cols();
  }
  return all;
}

/// Pressure columns of the velocity rows: b(v, q).
Eigen::MatrixXd supremizers(const PreparedScene& prepared, double angular_frequency,
                            const Eigen::MatrixXd& pressure) {
  const auto& disc = prepared.disc;
  std::vector<int> free;
  for (const int unknown : velocity_unknowns(disc))
    if (!disc.is_constrained[static_cast<std::size_t>(unknown)]) free.push_back(unknown);
  const SparseMatrix stiffness = prepared.operators.physical + prepared.operators.stabilisation;
  const ColumnSparse block = submatrix(stiffness, free);
  const ColumnSparse inner = 0.5 * (block + ColumnSparse(block.transpose())) +
                             angular_frequency * submatrix(prepared.operators.mass, free);
  Eigen::SimplicialLDLT<ColumnSparse> factors(inner);
  if (factors.info() != Eigen::Success)
    throw NumericsError("the inner product of the supremizers could not be factored", "training",
                        "larger Nitsche and ghost penalties (section [stabilisation])");
  const Eigen::MatrixXd forces = prepared.operators.physical * pressure;
  const Eigen::MatrixXd right = forces(free, Eigen::all);
  return expand(factors.solve(right), free, disc.unknowns());
}

/// Gram-Schmidt, twice, in `inner`: every column against those before it. Keeps nested spans.
void orthonormalise(Eigen::MatrixXd& columns, Eigen::Index first, const SparseMatrix& inner) {
  for (Eigen::Index j = first; j < columns.cols(); ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd weighted = inner * columns.col(j);
      const Eigen::VectorXd along = columns.leftCols(j).transpose() * weighted;
      columns.col(j) -= columns.leftCols(j) * along;
    }
    const double norm = std::sqrt(columns.col(j).dot(inner * columns.col(j)));
    columns.col(j) /= norm;
  }
}

} // namespace

Eigen::VectorXd imposed_lifting(const Discretisation<2>& disc) {
  Eigen::VectorXd lifting = Eigen::VectorXd::Zero(disc.unknowns());
  for (int unknown = disc.fluid_unknowns() + 1; unknown < disc.unknowns(); unknown += 2)
    lifting[unknown] = 1.0;
  return lifting;
}

Bases build_bases(const PreparedScene& prepared, const Scene& scene, std::span<const RunRecord> runs) {
  const auto& disc = prepared.disc;
  const auto& plan = scene.training;
  const double angular_frequency = std::numbers::pi * (plan.frequency_low + plan.frequency_high);
  const auto velocity_rows = velocity_unknowns(disc), pressure_rows = pressure_unknowns(disc),
             solid_rows = displacement_unknowns(disc);

  const SparseMatrix solid_energy =
      prepared.operators.stiffness + angular_frequency * angular_frequency * prepared.operators.mass;
  const ColumnSparse velocity_inner = submatrix(prepared.operators.mass, velocity_rows);
  const ColumnSparse pressure_inner = submatrix(pressure_product(prepared), pressure_rows);
  const ColumnSparse displacement_inner = submatrix(solid_energy, solid_rows);

  const auto relative_to_holder = [&](const RunRecord& run, Eigen::MatrixXd& values) {
    Scene at_point = scene;
    at_point.operating_point = run.point;
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const double holder = holder_displacement(at_point, run.times[static_cast<std::size_t>(k)]);
      for (Eigen::Index row = 1; row < values.rows(); row += 2) values(row, k) -= holder;
    }
  };
  const auto decompose = [&](const char* field, const ColumnSparse& inner, int modes, auto subtract) {
    return pod(gather(runs, field, inner, subtract), inner, {modes, modes > 0 ? 0.0 : plan.energy_tolerance});
  };
  const auto velocity = decompose(velocity_field, velocity_inner, plan.velocity_modes, nullptr);
  const auto pressure = decompose(pressure_field, pressure_inner, plan.pressure_modes, nullptr);
  const auto displacement =
      decompose(displacement_field, displacement_inner, plan.displacement_modes, relative_to_holder);

  Bases bases;
  bases.pressure = expand(pressure.modes, pressure_rows, disc.unknowns());
  bases.displacement = expand(displacement.modes, solid_rows, disc.unknowns());
  // Rounding of the imposed displacement must not leak into rows that the system does not solve for.
  for (const auto& node : disc.imposed) bases.displacement.middleRows<2>(node.unknown).setZero();
  const Eigen::MatrixXd proper = expand(velocity.modes, velocity_rows, disc.unknowns());
  Eigen::MatrixXd extra(disc.unknowns(), 0);
  if (plan.pressure_stability == PressureStability::supremizers)
    extra = supremizers(prepared, angular_frequency, bases.pressure);
  bases.supremizers = static_cast<int>(extra.cols());
  bases.velocity.resize(disc.unknowns(), proper.cols() + extra.cols());
  bases.velocity << proper, extra;
  const SparseMatrix& mass = prepared.operators.mass;
  orthonormalise(bases.velocity, proper.cols(), mass);
  bases.captured_velocity = velocity.captured_energy;
  bases.captured_pressure = pressure.captured_energy;
  bases.captured_displacement = displacement.captured_energy;
  return bases;
}

} // namespace undula::training
