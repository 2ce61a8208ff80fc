// What measured curves add to the tolerances of a scene: a linear update of independent normal inputs.
//
// Inputs z = (value - stated) / deviation with the tolerances of the scene are N(0, 1) before the data. With
// the effects A of a deviation on the measured flows, in deviations of the samples, and r the residuals in
// the same,
//   covariance of z = (1 + A^T A)^-1,   mean of z = covariance A^T r
// (Tarantola 2005, section 3.2). Exact where the flows are linear in the inputs.
#pragma once

#include <Eigen/Core>

#include "training/calibration/calibrate.hpp"
#include "training/calibration/uncertainty.hpp"

namespace undula::training {

/// An input, the data given; unit of the key.
struct PosteriorInput {
  std::string key;
  double value = 0, tolerance = 0; ///< before, as in the scene
  double shift = 0;                ///< by which the data would move the value
  double tolerance_given = 0;      ///< after: half width of the 95 % interval
  /// Half width of the profile likelihood's: what the data and the tolerances of the others tell without the
  /// own one. Infinite where they tell nothing.
  double tolerance_by_data = 0;
};

struct Posterior {
  std::vector<PosteriorInput> inputs;
  Eigen::MatrixXd correlation;    ///< of the inputs
  std::vector<double> half_width; ///< of the curve's 95 % interval at every predicted flow, l/min
  std::vector<double> shift;      ///< by which the data would move these flows, l/min
  double misfit = 0;              ///< root mean square of the residuals, in deviations
  int flows = 0;                  ///< that were given
};

/// Tolerances propagated to the `given` flows, and to those to predict. `residual`: measured - computed of
/// the given; `deviation`: standard deviations of the samples. Sides that could not be computed count as
/// propagate_tolerances says; an input without any at some flow has no effect there.
Posterior condition_on_data(const UncertaintyBand& given, const Eigen::VectorXd& residual,
                            const Eigen::VectorXd& deviation, const UncertaintyBand& predicted);

struct PosteriorEnsemble {
  Eigen::MatrixXd values; ///< draws x inputs, in their units
  Eigen::VectorXd misfit; ///< of each: root mean square of the residuals, in deviations
  int refused = 0;        ///< draws without an end: no flow can be had there, or the fit does not settle
};

/// Draws where the flows are not linear: randomised maximum likelihood (Oliver, He & Reynolds 1996). Every
/// draw moves the stated values and the measured flows by their own deviations and is fitted to them, by
/// steps of Gauss and Newton from the slopes of `given`. For linear flows the draws are those of
/// condition_on_data. `measured` in l/min, `flows` the given ones at values of the inputs; the same draws for
/// the same seed.
PosteriorEnsemble draw_inputs(const UncertaintyBand& given, const Eigen::VectorXd& measured,
                              const Eigen::VectorXd& deviation, const FlowsOfValues& flows, int count,
                              unsigned seed);

} // namespace undula::training
