// One implicit time step of the thin-gap level: what it starts from.
#pragma once

#include <array>

#include "fom/scene/scene.hpp"
#include "fom/thin_gap/gap_flow.hpp"
#include "fom/thin_gap/layout.hpp"
#include "fom/thin_gap/unknowns.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// What does not change within a step.
struct ThinGapStep {
  const ThinGapLayout* layout = nullptr;
  const Scene* scene = nullptr;
  GapFlowLaw law;
  ThinGapUnknowns at;
  double dt = 0;                   ///< s
  std::array<double, 3> alpha{};   ///< (alpha_0 y + alpha_1 y_old + alpha_2 y_older) / dt = dy/dt
  double outlet_pressure = 0;      ///< dyn/cm^2; the inlet is at zero
  double holder_displacement = 0;  ///< cm, at the end of the step, where it is imposed
  double voltage = 0;              ///< V, at the end of the step, where the holder is driven by it
  Eigen::VectorXd d_history;       ///< d = (dt v + d_history) / alpha_0 for the plate's velocities v
  Eigen::VectorXd x_history;       ///< dx/dt = (alpha_0 x + x_history) / dt
  Eigen::VectorXd upper_u_history; ///< the same for the velocities (cm/s) at the faces of the upper gap
  Eigen::VectorXd lower_u_history; ///< and of the lower gap
};

/// Whether the holder's motion is an unknown.
inline bool holder_is_free(const ThinGapStep& step) {
  return step.scene->operating_point.drive == Drive::voltage;
}

/// The closures of a scene.
GapFlowLaw gap_flow_law(const Scene& scene);

/// The step that follows `state`, by the scheme of the scene.
ThinGapStep next_step(const ThinGapLayout& layout, const Scene& scene, const State& state);

/// A step of backward Euler from the newer level of `state` to the time `end` (s), `dt` later.
ThinGapStep euler_step(const ThinGapLayout& layout, const Scene& scene, const State& state, double dt,
                       double end);

/// Displacements at the end of the step for the unknowns x.
Eigen::VectorXd displacements(const ThinGapStep& step, const Eigen::VectorXd& x);

/// Mean velocities at the faces of the upper and lower gap; zero in the chamber below the inlet's channel.
struct FaceVelocities {
  Eigen::VectorXd upper, lower; ///< cm/s, outwards, face i before node i
};
FaceVelocities face_velocities(const ThinGapLayout& layout, const GapFlowLaw& law, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& d);

/// Heights (cm) at a node for its deflection; `node` <= layout.channel for the upper gap.
inline double upper_height(const ThinGapLayout& layout, int node, double w) {
  return layout.upper_height[node] - w;
}
inline double lower_height(const ThinGapLayout& layout, int node, double w) {
  return layout.lower_height[node] + w;
}

} // namespace undula::fom
