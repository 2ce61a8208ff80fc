#include "training/sampling/scrambled_halton.hpp"

#include <array>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::training {
namespace {

constexpr std::array<int, ScrambledHalton::most_dimensions> primes{2,  3,  5,  7,  11, 13, 17, 19, 23, 29,
                                                                   31, 37, 41, 43, 47, 53, 59, 61, 67, 71};

} // namespace

ScrambledHalton::ScrambledHalton(std::uint32_t seed, int dimensions) {
  if (dimensions < 0 || dimensions > most_dimensions)
    throw InputError("too many dimensions of a space-filling plan", std::to_string(dimensions),
                     "at most " + std::to_string(most_dimensions), "the plan");
  std::mt19937 random(seed);
  for (int i = 0; i < dimensions; ++i) {
    const auto base = static_cast<std::uint32_t>(primes[static_cast<std::size_t>(i)]);
    std::vector<int> digits(base);
    std::iota(digits.begin(), digits.end(), 0);
    // Fisher-Yates by hand: std::shuffle differs between standard libraries.
    for (std::uint32_t k = base - 1; k > 1; --k) std::swap(digits[k], digits[1 + random() % k]);
    digits_.push_back(std::move(digits));
  }
}

std::vector<double> ScrambledHalton::operator()(int index) const {
  std::vector<double> point;
  for (const auto& digits : digits_) {
    const int base = static_cast<int>(digits.size());
    double digit_value = 1, sum = 0;
    for (int rest = index; rest > 0; rest /= base) {
      digit_value /= base;
      sum += digits[static_cast<std::size_t>(rest % base)] * digit_value;
    }
    point.push_back(sum);
  }
  return point;
}

} // namespace undula::training
