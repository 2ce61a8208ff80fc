// One head of a head-flow curve, as every level gives it.
#pragma once

#include "rom/curve/curve_point.hpp"

namespace undula::fom {
using rom::CurvePoint;
} // namespace undula::fom
