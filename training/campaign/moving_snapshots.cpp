#include "training/campaign/moving_snapshots.hpp"

#include "fom/time/time_stepper.hpp"
#include "training/campaign/check_record.hpp"
#include "training/campaign/recorded_run.hpp"

namespace undula::training {

void check_moving_record(const Discretisation<2>& disc, const Scene& scene, const RunRecord& record,
                         const std::string& file) {
  const auto steps = static_cast<std::size_t>(scene.time.steps_per_period);
  if (record.times.size() < steps)
    refuse_record("snapshots", std::to_string(record.times.size()),
                  std::to_string(steps) + ": every step of a period (training.snapshots_per_period)", file);
  const auto solids = static_cast<std::size_t>(disc.solid_unknowns());
  check_fields(record,
               {{velocity_field, velocity_unknowns(disc).size()},
                {pressure_field, pressure_unknowns(disc).size()},
                {displacement_field, solids},
                {solid_velocity_field, solids},
                {map_field, 2 * static_cast<std::size_t>(disc.vertex_nodes())}},
               file);
}

Eigen::VectorXd unknowns_at(const Discretisation<2>& disc, const RunRecord& record, Eigen::Index snapshot) {
  Eigen::VectorXd x(disc.unknowns());
  x(velocity_unknowns(disc)) = record.snapshots.at(velocity_field).values.col(snapshot);
  x(pressure_unknowns(disc)) = record.snapshots.at(pressure_field).values.col(snapshot);
  x.tail(disc.solid_unknowns()) = record.snapshots.at(solid_velocity_field).values.col(snapshot);
  return x;
}

Eigen::VectorXd displacements_at(const Discretisation<2>& disc, const RunRecord& record,
                                 Eigen::Index snapshot) {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
  d.tail(disc.solid_unknowns()) = record.snapshots.at(displacement_field).values.col(snapshot);
  return d;
}

DomainMap<2> map_at(const RunRecord& record, Eigen::Index snapshot, double time_step) {
  const auto& maps = record.snapshots.at(map_field).values;
  const auto alpha = bdf_coefficients(TimeScheme::bdf2, 2);
  const Eigen::VectorXd now = maps.col(snapshot);
  const Eigen::VectorXd rate =
      (alpha[0] * now + alpha[1] * maps.col(snapshot - 1) + alpha[2] * maps.col(snapshot - 2)) / time_step;
  return {by_node<2>(now), by_node<2>(rate)};
}

} // namespace undula::training
