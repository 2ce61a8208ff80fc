// What the equations of a step and its energies share: the two gaps, and the passages between them.
#pragma once

#include "fom/thin_gap/plate.hpp"
#include "fom/thin_gap/step.hpp"

namespace undula::fom {

/// Which of the two gaps: they differ in the places of their unknowns and in the sign of the deflection.
enum class GapSide { upper, lower };

inline int flow_at(const ThinGapUnknowns& at, GapSide side, int face) {
  return side == GapSide::upper ? at.upper_flow(face) : at.lower_flow(face);
}
inline int pressure_at(const ThinGapUnknowns& at, GapSide side, int node) {
  return side == GapSide::upper ? at.upper_pressure(node) : at.lower_pressure(node);
}
/// +1 where upwards deflection opens the gap.
inline double opening_sign(GapSide side) { return side == GapSide::upper ? -1 : 1; }
inline double rest_height(const ThinGapLayout& layout, GapSide side, int node) {
  return side == GapSide::upper ? layout.upper_height[node] : layout.lower_height[node];
}

/// Between the nodes before and behind a face, cm.
inline double face_length(const ThinGapLayout& layout, int face) {
  return layout.radius[face] - layout.radius[face - 1];
}

/// Losses of a passage as parts of the kinetic pressure where it is narrowest, by direction of its flow.
struct PassageLosses {
  double forwards = 0, backwards = 0;
};
inline PassageLosses rim_losses(const GapFlowLaw& law) {
  const double both = law.entry_loss + 1 - law.exit_recovery;
  return {both, both};
}
/// Of a channel, forwards being the flow into the pump. At the opening itself nothing is lost; where it holds
/// the static pressure, flow out takes its kinetic energy along.
inline PassageLosses channel_losses(const GapFlowLaw& law, OpeningCondition condition) {
  const double taken_along = condition == OpeningCondition::total_pressure ? 0.0 : 1.0;
  return {1 - law.exit_recovery, law.entry_loss + taken_along};
}

template <typename Number>
Number passage_drop(const GapFlowLaw& law, const Passage& passage, const PassageLosses& losses,
                    const Number& q, const Number& rate) {
  Number drop = law.density * passage.inertance * rate + law.viscosity * passage.resistance * q;
  if (law.convective) {
    const Number u = q / passage.area;
    if (q > 0)
      drop += 0.5 * losses.forwards * law.density * u * u;
    else
      drop -= 0.5 * losses.backwards * law.density * u * u;
  }
  return drop;
}

/// Nodes with flow in the gap: all of the lower one, those before the channel of the upper one.
inline int flow_nodes(const ThinGapLayout& layout, GapSide side) {
  return side == GapSide::upper ? layout.channel : static_cast<int>(layout.radius.size());
}

inline PlateElement plate_element(const ThinGapLayout& layout, int inner) {
  return {0.5 * (layout.radius[inner] + layout.radius[inner + 1]), face_length(layout, inner + 1),
          0.5 * (layout.thickness[inner] + layout.thickness[inner + 1])};
}

} // namespace undula::fom
