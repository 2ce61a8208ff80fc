// What the keys of a study do to a quantity.
//
// Two answers, both by least squares on the runs, x being the keys scaled to [-1, 1] over the box:
//   standardised regression coefficients  of y = b0 + sum b_i x_i: b_i s(x_i) / s(y), s the standard
//   deviation
//                                         over the runs (Saltelli et al., Global Sensitivity Analysis,
//                                         2008, 1.2.5); their squares add up to R^2 where the plan is
//                                         balanced
//   Sobol indices                         of a polynomial of degree 2 in orthonormal Legendre polynomials
//                                         (Sudret 2008, Reliab. Eng. Syst. Safety 93, 964-979), for keys that
//                                         are spread evenly over the box: first order (a key by itself) and
//                                         total (with all it does together with others)
// The part of the variance that a run left out is predicted to (Q^2) says how far the indices can be trusted.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "training/training.hpp"

namespace undula::training {

struct KeySensitivity {
  std::string key;
  double standardised = 0; ///< regression coefficient
  double first_order = std::numeric_limits<double>::quiet_NaN(), total = first_order; ///< NaN: too few runs
  double slope = 0; ///< of the polynomial's main effect over x in [-1, 1], in the unit of the quantity
  double bend = 0;  ///< its share of (3 x^2 - 1) / 2
};

struct Sensitivities {
  int runs = 0;      ///< that they are from
  double mean = 0;   ///< of the polynomial over the box; of the runs where there is none
  double linear = 0; ///< R^2 of the linear law
  double left_out = std::numeric_limits<double>::quiet_NaN(); ///< Q^2 of the polynomial; NaN: too few runs
  std::vector<KeySensitivity> keys; ///< none where the quantity does not change, or has too few runs
};

/// Of `y` at the rows of `x` (columns: keys, scaled to [-1, 1]). The polynomial takes twice as many runs as
/// it has terms; squares of keys with two values are left out. The linear law takes two runs more than keys.
Sensitivities sensitivities(const std::vector<std::string>& keys, const Eigen::MatrixXd& x,
                            const Eigen::VectorXd& y);

} // namespace undula::training
