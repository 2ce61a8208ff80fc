// Calibration: values of a scene's free keys that bring its head-flow curves closest to measured ones.
#pragma once

#include <mpi.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fom/levels/level.hpp"
#include "fom/scene/scene.hpp"
#include "training/calibration/bounded_fit.hpp"
#include "training/calibration/identifiability.hpp"
#include "training/training.hpp"

namespace undula::training {

/// A real-valued key of the scene table and the range it may take, in its unit.
struct FreeKey {
  std::string key;
  double low = 0, high = 0;
  /// A tolerance that holds the key: standard deviation about the value at which the scene states it; 0:
  /// none.
  double prior_deviation = 0, prior_value = 0;
};

/// A measured curve at the heads where it is compared.
struct TargetCurve {
  std::string name;
  double frequency_Hz = 0, stroke_mm = 0;        ///< the stroke of scenes that a stroke drives
  std::vector<double> head_mmHg, flow_l_per_min; ///< same length
  double scatter_l_per_min = 0;                  ///< standard deviation of a measured sample
  double voltage_V = 0;                          ///< of scenes that a voltage drives
};

/// "120 Hz, 0.53 mm" or "120 Hz, 40 V".
std::string setting_text(const TargetCurve& target);

/// Flows (l/min) of all curves one after the other, at values of the free keys in their units; nothing where
/// one of them cannot be computed.
using FlowsOfValues = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& values)>;

/// A curve before and after; flows in l/min at the heads of the target.
struct CalibratedCurve {
  std::vector<double> start_l_per_min, optimum_l_per_min;
  double start_rms_l_per_min = 0, optimum_rms_l_per_min = 0; ///< of computed - measured
  Eigen::MatrixXd sensitivity;                               ///< heads x keys: l/min per unit of the key
};

struct Calibration {
  Eigen::VectorXd start, optimum; ///< units of the keys
  std::vector<bool> at_bound;     ///< the optimum lies on an end of its range
  std::vector<CalibratedCurve> curves;
  Identifiability identified;
  bool converged = false;
  double misfit = 0; ///< sum of squares of the residuals and held keys in their deviations
  int points = 0;    ///< sets of values whose curves were computed
  int refused = 0;   ///< of them, without result
  double seconds = 0;
};

/// Mean flows of a periodic state are repeatable to about this, l/min: the training.periodic_tolerance of
/// shipped scenes leaves as much.
inline constexpr double flow_noise_l_per_min = 1e-3;

/// Flows of all targets, one after the other, l/min.
Eigen::VectorXd measured_flows(std::span<const TargetCurve> targets);

/// Standard deviation of every one of them: scatter of the data and noise of the flows.
Eigen::VectorXd deviations(std::span<const TargetCurve> targets);

/// Checks free keys against the scene and the targets. Throws InputError for an unknown or repeated key, a
/// range upside down or out of the key's own, a value of the scene outside its range, and for frequency,
/// stroke or head, which the data state.
void check_free_keys(const Scene& scene, std::span<const FreeKey> keys);

/// Scene with values of the free keys. Throws InputError as with_value.
Scene with_values(const Scene& scene, std::span<const FreeKey> keys, const Eigen::VectorXd& values);

/// Values of the free keys in the scene, in their units.
Eigen::VectorXd values_of(const Scene& scene, std::span<const FreeKey> keys);

/// Who answers for a scene; null: its own level (prepare_level).
using LevelOfScene = std::function<std::unique_ptr<Level>(const Scene&)>;

/// The flows of a scene at the frequency, stroke and heads of every target. The level is prepared once per
/// set of values. `on_failure` hears the reason where nothing is returned. `keys` and `targets` have to
/// outlive the function. Collective over `comm`.
FlowsOfValues flows_of_scene(const Scene& scene, std::span<const FreeKey> keys,
                             std::span<const TargetCurve> targets, MPI_Comm comm,
                             std::function<void(const std::string&)> on_failure, LevelOfScene level_of = {});

/// The scene at the frequency and drive of a target.
Scene at_setting(const Scene& scene, const TargetCurve& target);

/// Keys of the tolerances of a scene, each held by its own (a normal distribution of which it is the 95 %
/// interval), within three standard deviations, as far as the key allows. Keys in `beside` are left out.
std::vector<FreeKey> held_keys(const Scene& scene, std::span<const FreeKey> beside);

/// Least squares of computed - measured over all heads of all curves, each with the same weight, within the
/// ranges (fit_within_bounds). Where tolerances hold a key, the residuals count in deviations of the samples
/// and the distance of every such key from its stated value in deviations of it: the most probable values of
/// normal inputs. Standard errors take every head as one independent sample of the scatter of its data, and
/// the model as true. A key that changes the flow over its range by less than the noise of a difference,
/// flow_noise / difference_step, has no influence.
Calibration calibrate(const FlowsOfValues& flows, std::span<const FreeKey> keys, const Eigen::VectorXd& start,
                      std::span<const TargetCurve> targets, const FitOptions& options = {});

/// What the data do not fix, one sentence each; empty where they fix every key.
std::vector<std::string> identifiability_statements(std::span<const FreeKey> keys,
                                                    const Identifiability& identified);

} // namespace undula::training
