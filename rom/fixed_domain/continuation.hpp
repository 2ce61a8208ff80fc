// Warm starts along a head-flow curve.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace undula::rom {

/// Guesses the periodic state at a new head by a polynomial through the nearest solved heads.
class HeadContinuation {
public:
  /// Order of solution in which most points lie between solved ones: the ends, then halves of the widest
  /// gaps.
  static std::vector<std::size_t> order(std::span<const double> heads);

  void add(double head, const Eigen::MatrixXd& velocity);

  /// Coefficients (nu x as many as the richest of the states used); empty while no state is known.
  Eigen::MatrixXd guess(double head) const;

private:
  struct Solved {
    double head;
    Eigen::MatrixXd velocity;
  };
  std::vector<Solved> solved_;
};

} // namespace undula::rom
