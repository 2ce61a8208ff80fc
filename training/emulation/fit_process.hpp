// The parameters of a Gaussian process that make the observed values most likely.
#pragma once

#include "rom/emulator/gaussian_process.hpp"

namespace undula::training {

/// Maximises the restricted likelihood over lengths (0.05 to 10 of the unit interval), variance and nugget,
/// the latter two as parts of the values' scatter about a linear trend. Searched by BOBYQA from several
/// starts, the same on every machine; of maxima that are equal the one of the longest lengths counts.
/// Arguments and errors as of rom::GaussianProcess.
rom::GaussianProcess fit_process(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                 const Eigen::VectorXd& noise);

} // namespace undula::training
