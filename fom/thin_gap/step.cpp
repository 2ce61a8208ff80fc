#include "fom/thin_gap/step.hpp"

#include <cmath>
#include <numbers>

#include "fom/scene/operating_point.hpp"
#include "fom/scene/scene_time.hpp"
#include "fom/thin_gap/step_terms.hpp"

namespace undula::fom {

GapFlowLaw gap_flow_law(const Scene& scene) {
  const auto& settings = scene.thin_gap;
  GapFlowLaw law;
  law.density = scene.fluid.density;
  law.viscosity = scene.fluid.viscosity;
  law.momentum_factor = settings.momentum_factor;
  law.throat_recovery = settings.throat_recovery;
  law.exit_recovery = settings.exit_recovery;
  law.entry_loss = settings.entry_loss;
  if (settings.friction == GapFriction::oscillatory)
    law.stokes_layer = std::sqrt(scene.fluid.viscosity / scene.fluid.density /
                                 (std::numbers::pi * scene.operating_point.frequency));
  law.least_height = settings.film_thickness / 2;
  const auto& point = scene.operating_point;
  const double holder_speed =
      2 * std::numbers::pi * point.frequency * std::abs(point.stroke_scale * point.stroke);
  law.turning_velocity = std::max(0.1 * holder_speed, 0.1); // cm/s; kinetic pressures there are negligible
  law.convective = scene.flow != FlowModel::stokes;
  return law;
}

FaceVelocities face_velocities(const ThinGapLayout& layout, const GapFlowLaw& law, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& d) {
  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  FaceVelocities u{Eigen::VectorXd::Zero(at.nodes + 1), Eigen::VectorXd::Zero(at.nodes + 1)};
  for (const GapSide side : {GapSide::upper, GapSide::lower}) {
    const auto opened = [&](int node) {
      return open_height(law, rest_height(layout, side, node) + opening_sign(side) * d[at.deflection(node)]);
    };
    const int last = side == GapSide::upper ? layout.channel : at.nodes - 1;
    for (int face = 0; face <= last; ++face) {
      const double h = face == 0 ? opened(0) : 0.5 * (opened(face - 1) + opened(face));
      (side == GapSide::upper ? u.upper : u.lower)[face] =
          x[flow_at(at, side, face)] / (2 * std::numbers::pi * face_radius(layout, face) * h);
    }
  }
  return u;
}

namespace {

ThinGapStep step_to(const ThinGapLayout& layout, const Scene& scene, const State& state,
                    const std::array<double, 3>& alpha, double dt, double end) {
  ThinGapStep step;
  step.layout = &layout;
  step.scene = &scene;
  step.law = gap_flow_law(scene);
  step.at.nodes = static_cast<int>(layout.radius.size());
  step.dt = dt;
  step.alpha = alpha;
  step.outlet_pressure = outlet_pressure(scene, end);
  step.holder_displacement = holder_displacement(scene, end);
  step.voltage = drive_voltage(scene, end);
  step.d_history = -alpha[1] * state.d[0] - alpha[2] * state.d[1];
  step.x_history = alpha[1] * state.x[0] + alpha[2] * state.x[1];
  const auto now = face_velocities(layout, step.law, state.x[0], state.d[0]);
  const auto before = face_velocities(layout, step.law, state.x[1], state.d[1]);
  step.upper_u_history = alpha[1] * now.upper + alpha[2] * before.upper;
  step.lower_u_history = alpha[1] * now.lower + alpha[2] * before.lower;
  return step;
}

} // namespace

ThinGapStep next_step(const ThinGapLayout& layout, const Scene& scene, const State& state) {
  const double dt = time_step(scene);
  return step_to(layout, scene, state, bdf_coefficients(scene.time.scheme, state.step), dt,
                 (state.step + 1) * dt);
}

ThinGapStep euler_step(const ThinGapLayout& layout, const Scene& scene, const State& state, double dt,
                       double end) {
  return step_to(layout, scene, state, {1, -1, 0}, dt, end);
}

Eigen::VectorXd displacements(const ThinGapStep& step, const Eigen::VectorXd& x) {
  Eigen::VectorXd d(step.at.displacements());
  for (int node = 0; node < step.at.nodes; ++node)
    for (int k = 0; k < 3; ++k) {
      const int place = step.at.deflection(node) + k;
      d[place] = (step.dt * x[step.at.deflection_rate(node) + k] + step.d_history[place]) / step.alpha[0];
    }
  return d;
}

} // namespace undula::fom
