#include "training/emulation/fit_responses.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fom/levels/emulated_level.hpp"
#include "fom/scene/operating_point.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/check_record.hpp"
#include "training/campaign/moving_snapshots.hpp"
#include "training/emulation/fit_process.hpp"
#include "training/emulation/quantile.hpp"
#include "training/reduction/pod.hpp"
#include "training/sampling/trainable_scene.hpp"

namespace undula::training {
namespace {

constexpr int steps_per_phase = 2;
constexpr int most_modes = 12;

/// Values of a record at the phases of its last period; `at` gives those of a snapshot.
template <typename AtSnapshot>
Eigen::VectorXd over_period(const Scene& scene, const RunRecord& record, Eigen::Index places,
                            const AtSnapshot& at) {
  const int steps = scene.time.steps_per_period, phases = steps / steps_per_phase;
  Eigen::VectorXd values =
      Eigen::VectorXd::Constant(places * phases, std::numeric_limits<double>::quiet_NaN());
  const auto count = static_cast<Eigen::Index>(record.times.size());
  for (Eigen::Index k = count - steps; k < count; ++k) {
    const double turns = record.times[static_cast<std::size_t>(k)] * record.point.frequency;
    const int step = static_cast<int>(std::lround((turns - std::floor(turns)) * steps)) % steps;
    if (step % steps_per_phase == 0) values.segment(step / steps_per_phase * places, places) = at(k);
  }
  if (!values.allFinite())
    refuse_record("times of the last period", "phases without a snapshot", "a snapshot at every step",
                  plain_number(record.point.frequency) + " Hz");
  return values;
}

/// Least and largest value at every place.
Eigen::VectorXd envelope(const Eigen::VectorXd& values, Eigen::Index places) {
  const Eigen::Map<const Eigen::MatrixXd> by_phase(values.data(), places, values.size() / places);
  Eigen::VectorXd result(2 * places);
  result << by_phase.rowwise().minCoeff(), by_phase.rowwise().maxCoeff();
  return result;
}

/// The first modes of what runs differ by; none where they do not.
Eigen::MatrixXd shared_modes(const Eigen::MatrixXd& centred) {
  if (centred.norm() == 0) return Eigen::MatrixXd(centred.rows(), 0);
  Eigen::SparseMatrix<double> identity(centred.rows(), centred.rows());
  identity.setIdentity();
  const int most = std::min(most_modes, static_cast<int>(centred.cols()) - 1); // the mean is one of them
  return pod(centred, identity, {most, 0}).modes;
}

/// Norm of the differences over that of the runs, of the values and of their envelopes.
struct Misses {
  double values = 0, size = 0, envelopes = 0, envelope_size = 0;
  void add(const Eigen::VectorXd& emulated, const Eigen::VectorXd& run, Eigen::Index places) {
    values += (emulated - run).squaredNorm();
    size += run.squaredNorm();
    const auto exact = envelope(run, places);
    envelopes += (envelope(emulated, places) - exact).squaredNorm();
    envelope_size += exact.squaredNorm();
  }
  double of_values() const { return size > 0 ? std::sqrt(values / size) : 0; }
  double of_envelopes() const { return envelope_size > 0 ? std::sqrt(envelopes / envelope_size) : 0; }
};

} // namespace

std::vector<RecordedResponse> recorded_quantities(const PreparedScene& prepared, const Scene& scene) {
  const int phases = scene.time.steps_per_period / steps_per_phase;
  std::vector<double> radii;
  for (const double radius : prepared.observation.probes.radius) radii.push_back(units::length_to_mm(radius));
  return {{rom::membrane_response, "mm", std::move(radii), phases, {}, {}},
          {rom::outflow_response, "l/min", {0.0}, phases, {}, {}}};
}

std::vector<Eigen::VectorXd> recorded_values(const PreparedScene& prepared, const Scene& scene,
                                             const RunRecord& record) {
  const auto& disc = prepared.disc;
  const auto& probes = prepared.observation.probes;
  const auto& flux = prepared.operators.openings.at(outlet_name);
  return {over_period(scene, record, static_cast<Eigen::Index>(probes.radius.size()),
                      [&](Eigen::Index k) -> Eigen::VectorXd {
                        return probes.axial_displacement(displacements_at(disc, record, k)) *
                               units::length_to_mm(1);
                      }),
          over_period(scene, record, 1, [&](Eigen::Index k) -> Eigen::VectorXd {
            return Eigen::VectorXd::Constant(
                1, units::flow_to_l_per_min(flux.dot(unknowns_at(disc, record, k))));
          })};
}

ResponseScore fit_response(const RecordedResponse& recorded,
                           const std::vector<rom::EmulatorPoint>& training_points,
                           const std::vector<rom::EmulatorPoint>& held_out_points, rom::Emulator& emulator) {
  const Eigen::Index runs = recorded.training.cols();
  const auto places = static_cast<Eigen::Index>(recorded.places_mm.size());
  Eigen::MatrixXd inputs(rom::scaled_point(emulator, training_points.front()).size(), runs);
  for (Eigen::Index i = 0; i < runs; ++i)
    inputs.col(i) = rom::scaled_point(emulator, training_points[static_cast<std::size_t>(i)]);

  rom::EmulatedResponse response{recorded.name,
                                 recorded.unit,
                                 recorded.places_mm,
                                 recorded.phases,
                                 recorded.training.rowwise().mean(),
                                 {},
                                 {},
                                 0};
  const Eigen::MatrixXd centred = recorded.training.colwise() - response.mean;
  response.modes.resize(centred.rows(), 0);
  Eigen::MatrixXd left_out = response.mean.replicate(1, runs); // every run from all others
  Eigen::Index modes = 0;
  const Eigen::VectorXd noise = Eigen::VectorXd::Zero(runs);
  const Eigen::MatrixXd shared = shared_modes(centred);
  for (const auto mode : shared.colwise()) {
    const Eigen::VectorXd coefficients = centred.transpose() * mode;
    auto process = fit_process(inputs, coefficients, noise);
    const Eigen::VectorXd told = process.leave_one_out().col(0);
    if ((told - coefficients).squaredNorm() >= coefficients.squaredNorm()) continue;
    response.modes.conservativeResize(Eigen::NoChange, modes + 1);
    response.modes.col(modes) = mode;
    left_out += mode * told.transpose();
    ++modes;
    response.coefficients.push_back(std::move(process));
  }

  ResponseScore score{recorded.name, static_cast<int>(modes)};
  Misses missed, missed_held_out;
  std::vector<double> errors;
  const double root = std::sqrt(static_cast<double>(response.mean.size()));
  for (Eigen::Index i = 0; i < runs; ++i) {
    missed.add(left_out.col(i), recorded.training.col(i), places);
    errors.push_back((left_out.col(i) - recorded.training.col(i)).norm() / root);
  }
  response.error = quantile(errors, nine_in_ten);
  for (Eigen::Index i = 0; i < recorded.held_out.cols(); ++i) {
    const Eigen::MatrixXd told =
        rom::emulate(emulator, response, held_out_points[static_cast<std::size_t>(i)]).values;
    missed_held_out.add(told.reshaped(), recorded.held_out.col(i), places);
  }
  score.left_out = missed.of_values(), score.envelope = missed.of_envelopes();
  score.held_out = missed_held_out.of_values(), score.envelope_held_out = missed_held_out.of_envelopes();
  emulator.responses.push_back(std::move(response));
  return score;
}

void add_responses(BuiltEmulator& built, const Scene& scene, const SamplingPlan& plan,
                   const CampaignStore& store, PhaseTimer& timer) {
  if (!has_mapped_domain(scene) || scene.training.snapshots_per_period != scene.time.steps_per_period) return;
  for (const auto& key : varied_keys(scene))
    for (const char* section : {"geometry.", "mesh.", "refine.", "space.", "time."})
      if (key.key.starts_with(section)) {
        built.not_used.push_back("the courses over a period: " + key.key +
                                 " changes where or when they are known");
        return;
      }
  auto& emulator = built.emulator;
  const auto prepared = prepare_scene(scene, MPI_COMM_SELF, timer);
  auto quantities = recorded_quantities(*prepared, scene);
  const auto collect = [&](const std::vector<OperatingPoint>& points,
                           Eigen::MatrixXd RecordedResponse::*values_of) {
    std::vector<rom::EmulatorPoint> used;
    for (const auto& at : points) {
      auto point = emulator_point(emulator, at);
      if (std::ranges::find(emulator.runs, point, &rom::EmulatorRun::point) == emulator.runs.end()) continue;
      const auto record = store.load(at);
      check_moving_record(prepared->disc, scene, record, store.record_file(at).string());
      const auto values = recorded_values(*prepared, scene, record);
      for (std::size_t q = 0; q < quantities.size(); ++q) {
        auto& all = quantities[q].*values_of;
        all.conservativeResize(values[q].size(), all.cols() + 1);
        all.rightCols(1) = values[q];
      }
      used.push_back(std::move(point));
    }
    return used;
  };
  const auto training_points = collect(plan.training, &RecordedResponse::training);
  const auto held_out_points = collect(plan.held_out, &RecordedResponse::held_out);
  for (const auto& recorded : quantities)
    built.responses.push_back(fit_response(recorded, training_points, held_out_points, emulator));
}

} // namespace undula::training
