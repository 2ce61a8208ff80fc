// One place under a roller: bore, flow and friction at samples along it.
#pragma once

#include <vector>

#include "fom/long_wave/hose_model.hpp"

namespace undula::fom {

/// A sample of a quadrature along the hose. The flow there is that at the place's right edge plus `added`.
struct PlaceSample {
  double offset = 0;      ///< cm, from the roller
  double length = 0;      ///< cm, the weight of the sample
  double height = 0;      ///< cm, of the bore
  double area = 0;        ///< cm^2
  double conductance = 0; ///< cm^4
  double diameter = 0;    ///< cm, hydraulic
  double added = 0;       ///< cm^3/s
};

struct SqueezedPlace {
  PressedPlace at;
  double reach = 0;                 ///< cm, it spans position - reach .. position + reach
  std::vector<PlaceSample> samples; ///< from left to right
  double throat_area = 0;           ///< cm^2, under the roller
  double throat_added = 0;          ///< cm^3/s, `added` there
  double left_added = 0;            ///< cm^3/s, `added` at the left edge
};

/// The samples follow the height on a scale of their own, so that a thin film is resolved as well as a wide
/// one: offset = sqrt(2 r gap) sinh(x), with x in equal panels of three Gauss points.
SqueezedPlace squeezed_place(const HoseModel& model, const PressedPlace& at);

/// PlaceSample::added at an offset within the reach: what the moving bore between there and the right edge
/// takes up or gives.
double added_flow(const HoseModel& model, const PressedPlace& at, double offset);

/// Height of the bore there, cm.
double place_height(const HoseModel& model, const PressedPlace& at, double offset);

} // namespace undula::fom
