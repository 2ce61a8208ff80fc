// A space-filling sequence in the unit cube of any dimension.
#pragma once

#include <cstdint>
#include <vector>

#include "training/training.hpp"

namespace undula::training {

/// Halton sequence (Halton 1960) with one random permutation of the digits per dimension (0 stays 0, so that
/// every number has finitely many digits), drawn from a fixed seed: unscrambled, the first points of bases 3
/// and 5 line up. The same on every machine; the first dimensions do not depend on how many there are.
class ScrambledHalton {
public:
  /// Throws InputError beyond `most_dimensions`.
  ScrambledHalton(std::uint32_t seed, int dimensions);
  static constexpr int most_dimensions = 20;

  /// Point number `index` >= 1, every coordinate in (0, 1).
  std::vector<double> operator()(int index) const;

private:
  std::vector<std::vector<int>> digits_; ///< [dimension][digit]; as many as the base
};

} // namespace undula::training
