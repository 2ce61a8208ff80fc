#include "fom/problem/problem.hpp"

#include <numbers>

namespace undula::fom {

double Measure::operator()(double r) const { return axisymmetric ? 2.0 * std::numbers::pi * r : 1.0; }

Measure measure_of(Space space) { return Measure{space == Space::axisymmetric}; }

} // namespace undula::fom
