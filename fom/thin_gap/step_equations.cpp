#include "fom/thin_gap/step_equations.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/AutoDiff>

#include "fom/pump_problem.hpp"
#include "fom/simulation.hpp"
#include "fom/thin_gap/plate.hpp"

namespace undula {

namespace {

constexpr double pi = std::numbers::pi;

/// Which of the two gaps: they differ in the places of their unknowns and in the sign of the deflection.
enum class Side { upper, lower };

int flow_at(const ThinGapUnknowns& at, Side side, int face) {
  return side == Side::upper ? at.upper_flow(face) : at.lower_flow(face);
}
int pressure_at(const ThinGapUnknowns& at, Side side, int node) {
  return side == Side::upper ? at.upper_pressure(node) : at.lower_pressure(node);
}
/// +1 where upwards deflection opens the gap.
double opening_sign(Side side) { return side == Side::upper ? -1 : 1; }
double rest_height(const ThinGapLayout& layout, Side side, int node) {
  return side == Side::upper ? layout.upper_height[node] : layout.lower_height[node];
}

/// Between the nodes before and behind a face, cm.
double face_length(const ThinGapLayout& layout, int face) {
  return layout.radius[face] - layout.radius[face - 1];
}

/// Numbers with derivatives by the unknowns that one equation reads.
template <int count>
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, count, 1>>;

/// The same, or plain numbers where derivatives are not asked for.
template <bool derive, int count>
using Value = std::conditional_t<derive, Dual<count>, double>;

template <bool derive, int count>
std::array<Value<derive, count>, count> read(const Eigen::VectorXd& x, const std::array<int, count>& places) {
  std::array<Value<derive, count>, count> values;
  for (int k = 0; k < count; ++k) {
    if constexpr (derive)
      values[k] = Dual<count>(x[places[k]], count, k);
    else
      values[k] = x[places[k]];
  }
  return values;
}

template <int count>
void write(double value, int row, const std::array<int, count>&, Eigen::VectorXd& residual, BandMatrix*) {
  residual[row] += value;
}

template <int count>
void write(const Dual<count>& value, int row, const std::array<int, count>& places, Eigen::VectorXd& residual,
           BandMatrix* matrix) {
  residual[row] += value.value();
  for (int k = 0; k < count; ++k)
    if (value.derivatives()[k] != 0) (*matrix)(row, places[k]) += value.derivatives()[k];
}

/// Deflection of a node that moves at velocity v.
template <typename Number>
Number deflection(const ThinGapStep& step, int node, const Number& v) {
  return Number((step.dt * v + step.d_history[step.at.deflection(node)]) / step.alpha[0]);
}

template <typename Number>
Number height(const ThinGapStep& step, Side side, int node, const Number& v) {
  const Number w = deflection(step, node, v);
  return open_height(step.law, Number(rest_height(*step.layout, side, node) + opening_sign(side) * w));
}

template <typename Number>
Number time_derivative(const ThinGapStep& step, const Number& y, double history) {
  return Number((step.alpha[0] * y + history) / step.dt);
}

double u_history(const ThinGapStep& step, Side side, int face) {
  return (side == Side::upper ? step.upper_u_history : step.lower_u_history)[face];
}

/// Faces 1 .. last - 1 of a gap: momentum between two nodes.
template <typename Number>
Number inner_momentum(const ThinGapStep& step, Side side, int face, const Number& q_before, const Number& q,
                      const Number& q_after, const Number& p_inner, const Number& p_outer,
                      const Number& h_inner, const Number& h_outer) {
  const auto& layout = *step.layout;
  const auto& law = step.law;
  const double r_inner = layout.radius[face - 1], r_outer = layout.radius[face];
  const Number h = 0.5 * (h_inner + h_outer);
  const Number u = q / (2 * pi * face_radius(layout, face) * h);
  // At the tip the flow of the gap's own end counts.
  const Number u_inner = face == 1 ? Number(q_before / (2 * pi * r_inner * h_inner))
                                   : Number((q_before + q) / (4 * pi * r_inner * h_inner));
  const Number u_outer = (q + q_after) / (4 * pi * r_outer * h_outer);
  const Number rate = time_derivative(step, u, u_history(step, side, face));
  const Number convective =
      convective_drop(law, u, Number(kinetic_pressure(law, u_inner)), Number(kinetic_pressure(law, u_outer)));
  return Number(law.density * law.momentum_factor * face_length(layout, face) * rate + p_outer - p_inner +
                convective + gap_friction(law, h) * u * face_length(layout, face));
}

/// Where a gap begins at the tip.
template <typename Number>
Number tip_momentum(const ThinGapStep& step, const Number& q, const Number& p_tip, const Number& p,
                    const Number& h) {
  const Number u = q / (2 * pi * step.layout->radius.front() * h);
  return Number(p - p_tip + drop_at_beginning(step.law, u, Number(kinetic_pressure(step.law, u))));
}

/// Where the upper gap ends at the chamber below the inlet's channel, half a step behind its last node.
template <typename Number>
Number chamber_momentum(const ThinGapStep& step, const Number& q_before, const Number& q, const Number& p_gap,
                        const Number& p_chamber, const Number& h_inner, const Number& h_outer) {
  const auto& layout = *step.layout;
  const auto& law = step.law;
  const int face = layout.channel;
  const Number h = 0.5 * (h_inner + h_outer);
  const Number u = q / (2 * pi * face_radius(layout, face) * h);
  const Number u_inner = (q_before + q) / (4 * pi * layout.radius[face - 1] * h_inner);
  const Number rate = time_derivative(step, u, u_history(step, Side::upper, face));
  return Number(0.5 * face_length(layout, face) *
                    (law.density * law.momentum_factor * rate + gap_friction(law, h) * u) +
                p_chamber - p_gap + drop_at_end(law, u, Number(kinetic_pressure(law, u_inner))));
}

/// Losses of a passage as parts of the kinetic pressure where it is narrowest, by direction of its flow.
struct PassageLosses {
  double forwards = 0, backwards = 0;
};
PassageLosses rim_losses(const GapFlowLaw& law) {
  const double both = law.entry_loss + 1 - law.exit_recovery;
  return {both, both};
}
/// Of a channel, forwards being the flow into the pump. At the opening itself nothing is lost; where it holds
/// the static pressure, flow out takes its kinetic energy along.
PassageLosses channel_losses(const GapFlowLaw& law, OpeningCondition condition) {
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
int flow_nodes(const ThinGapLayout& layout, Side side) {
  return side == Side::upper ? layout.channel : static_cast<int>(layout.radius.size());
}

template <bool derive>
void assemble_gap(const ThinGapStep& step, Side side, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                  BandMatrix* matrix) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  const int last = flow_nodes(layout, side);
  {
    const std::array<int, 4> places = {flow_at(at, side, 0), at.tip_pressure, pressure_at(at, side, 0),
                                       at.deflection_rate(0)};
    const auto y = read<derive, 4>(x, places);
    write<4>(tip_momentum(step, y[0], y[1], y[2], height(step, side, 0, y[3])), places[0], places, residual,
             matrix);
  }
  for (int face = 1; face < last; ++face) {
    const std::array<int, 7> places = {flow_at(at, side, face - 1), flow_at(at, side, face),
                                       flow_at(at, side, face + 1), pressure_at(at, side, face - 1),
                                       pressure_at(at, side, face), at.deflection_rate(face - 1),
                                       at.deflection_rate(face)};
    const auto y = read<derive, 7>(x, places);
    write<7>(inner_momentum(step, side, face, y[0], y[1], y[2], y[3], y[4],
                            height(step, side, face - 1, y[5]), height(step, side, face, y[6])),
             places[1], places, residual, matrix);
  }
  if (side == Side::upper) {
    const std::array<int, 6> places = {flow_at(at, side, last - 1),     flow_at(at, side, last),
                                       pressure_at(at, side, last - 1), pressure_at(at, side, last),
                                       at.deflection_rate(last - 1),    at.deflection_rate(last)};
    const auto y = read<derive, 6>(x, places);
    write<6>(chamber_momentum(step, y[0], y[1], y[2], y[3], height(step, side, last - 1, y[4]),
                              height(step, side, last, y[5])),
             places[1], places, residual, matrix);
    for (int face = last + 1; face < at.nodes; ++face) { // one pressure in the chamber
      const int row = at.upper_flow(face), outer = at.upper_pressure(face),
                inner = at.upper_pressure(face - 1);
      residual[row] += x[outer] - x[inner];
      if (matrix) {
        (*matrix)(row, outer) += 1;
        (*matrix)(row, inner) -= 1;
      }
    }
  }
  for (int node = 0; node < at.nodes; ++node) { // volume
    const int row = pressure_at(at, side, node);
    const double opening = opening_sign(side) * node_area(layout, node);
    const int inner = flow_at(at, side, node), outer = flow_at(at, side, node + 1),
              v = at.deflection_rate(node);
    residual[row] += opening * x[v] + x[outer] - x[inner];
    if (matrix) {
      (*matrix)(row, v) += opening;
      (*matrix)(row, outer) += 1;
      (*matrix)(row, inner) -= 1;
    }
  }
}

template <bool derive>
void assemble_passages(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                       BandMatrix* matrix) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  const auto& law = step.law;
  const auto& history = step.x_history;
  { // Outlet; what enters through it goes into the gaps.
    const int upper = at.upper_flow(0), lower = at.lower_flow(0);
    const std::array<int, 3> places = {at.tip_pressure, upper, lower};
    const auto y = read<derive, 3>(x, places);
    const Value<derive, 3> q = y[1] + y[2];
    const Value<derive, 3> drop = passage_drop(law, layout.outlet, channel_losses(law, step.scene->outlet), q,
                                               time_derivative(step, q, history[upper] + history[lower]));
    write<3>(Value<derive, 3>(step.outlet_pressure - y[0] - drop), at.tip_pressure, places, residual, matrix);
  }
  const int last = at.nodes - 1, upper = at.upper_flow(at.nodes), lower = at.lower_flow(at.nodes);
  { // Rim, from the lower to the upper chamber. The flow brings along what kinetic pressure it has below.
    const std::array<int, 5> places = {lower, at.lower_pressure(last), at.upper_pressure(last),
                                       at.lower_flow(last), at.deflection_rate(last)};
    const auto y = read<derive, 5>(x, places);
    const Value<derive, 5> drop =
        passage_drop(law, layout.rim, rim_losses(law), y[0], time_derivative(step, y[0], history[lower]));
    Value<derive, 5> below = y[1];
    if (law.convective)
      below += kinetic_pressure(
          law, Value<derive, 5>((y[3] + y[0]) /
                                (4 * pi * layout.radius[last] * height(step, Side::lower, last, y[4]))));
    write<5>(Value<derive, 5>(below - y[2] - drop), lower, places, residual, matrix);
  }
  { // Inlet: the upper chamber gives to the gap what comes by the rim and by the inlet.
    const std::array<int, 3> places = {upper, lower, at.upper_pressure(last)};
    const auto y = read<derive, 3>(x, places);
    const Value<derive, 3> q = -(y[0] + y[1]);
    const Value<derive, 3> drop = passage_drop(law, layout.inlet, channel_losses(law, step.scene->inlet), q,
                                               time_derivative(step, q, -(history[upper] + history[lower])));
    write<3>(Value<derive, 3>(-y[2] - drop), upper, places, residual, matrix);
  }
}

template <bool derive>
void assemble_contact(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                      BandMatrix* matrix) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  for (int node = 0; node < layout.channel; ++node) {
    const std::array<int, 1> places = {at.deflection_rate(node)};
    const auto y = read<derive, 1>(x, places);
    const Value<derive, 1> w = deflection(step, node, y[0]);
    const auto& settings = step.scene->thin_gap;
    const Value<derive, 1> net = contact_pressure(settings, Value<derive, 1>(layout.upper_height[node] - w)) -
                                 contact_pressure(settings, Value<derive, 1>(layout.lower_height[node] + w));
    write<1>(Value<derive, 1>(node_area(layout, node) * net), places[0], places, residual, matrix);
  }
}

PlateElement plate_element(const ThinGapLayout& layout, int inner) {
  return {0.5 * (layout.radius[inner] + layout.radius[inner + 1]), face_length(layout, inner + 1),
          0.5 * (layout.thickness[inner] + layout.thickness[inner + 1])};
}

template <bool derive>
void assemble_plate(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                    BandMatrix* matrix) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  const auto& material = step.scene->membrane;
  const auto model = step.scene->solid_model;
  // Beyond the holder's first node the plate moves as a whole.
  for (int inner = 0; inner < layout.clamp; ++inner) {
    using D = Value<derive, 6>;
    std::array<int, 6> places;
    for (int k = 0; k < 3; ++k) {
      places[k] = at.deflection_rate(inner) + k;
      places[3 + k] = at.deflection_rate(inner + 1) + k;
    }
    const auto y = read<derive, 6>(x, places);
    const std::array<PlateNode<D>, 2> v = {{{y[0], y[1], y[2]}, {y[3], y[4], y[5]}}};
    const auto moved = [&](int node, const PlateNode<D>& rate) {
      const int first = at.deflection(node);
      const auto place = [&](const D& y_rate, int k) {
        return D((step.dt * y_rate + step.d_history[first + k]) / step.alpha[0]);
      };
      return PlateNode<D>{place(rate.w, 0), place(rate.theta, 1), place(rate.u, 2)};
    };
    const auto forces = plate_forces<D>(plate_element(layout, inner), material, model,
                                        {moved(inner, v[0]), moved(inner + 1, v[1])}, v);
    const std::array<const D*, 6> rows = {&forces.inner.w, &forces.inner.theta, &forces.inner.u,
                                          &forces.outer.w, &forces.outer.theta, &forces.outer.u};
    for (int k = 0; k < 6; ++k) write<6>(*rows[k], places[k], places, residual, matrix);
  }
  for (int node = 0; node < at.nodes; ++node) {
    const double area = node_area(layout, node), h = layout.thickness[node];
    const double mass = material.density * h * area, rotary = mass * h * h / 12;
    const double factor = step.alpha[0] / step.dt;
    for (const auto& [row, inertia] : {std::pair{at.deflection_rate(node), mass},
                                       {at.rotation_rate(node), rotary},
                                       {at.radial_rate(node), mass}}) {
      residual[row] += inertia * time_derivative(step, x[row], step.x_history[row]);
      if (matrix) (*matrix)(row, row) += inertia * factor;
    }
    const int w = at.deflection_rate(node);
    residual[w] += area * (x[at.upper_pressure(node)] - x[at.lower_pressure(node)]);
    if (matrix) {
      (*matrix)(w, at.upper_pressure(node)) += area;
      (*matrix)(w, at.lower_pressure(node)) -= area;
    }
  }
}

/// Replaces the plate's equations in the holder by its motion. Returns the force of the actuator.
double impose_holder(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                     BandMatrix* matrix) {
  const auto& at = step.at;
  double force = 0;
  for (int node = step.layout->clamp; node < at.nodes; ++node) {
    force += residual[at.deflection_rate(node)];
    for (int k = 0; k < 3; ++k) {
      const int row = at.deflection_rate(node) + k;
      const double target = k == 0 ? step.holder_displacement : 0.0;
      residual[row] = x[row] - (step.alpha[0] * target - step.d_history[at.deflection(node) + k]) / step.dt;
      if (matrix) {
        matrix->clear_row(row);
        (*matrix)(row, row) = 1;
      }
    }
  }
  return force;
}

/// Power that flow loses between two places, and kinetic energy of what lies between.
double gap_dissipation(const ThinGapStep& step, Side side, const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                       double& kinetic) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  const auto& law = step.law;
  const auto opened = [&](int node) {
    return open_height(law, rest_height(layout, side, node) + opening_sign(side) * d[at.deflection(node)]);
  };
  double power = 0;
  const int last = flow_nodes(layout, side);
  const auto q = [&](int face) { return x[flow_at(at, side, face)]; };
  const auto node_kinetic = [&](int node) {
    const double flow = node == 0 ? q(0) : 0.5 * (q(node) + q(node + 1));
    return kinetic_pressure(law, flow / (2 * pi * layout.radius[node] * opened(node)));
  };
  if (law.convective) power += q(0) * (drop_at_beginning(law, q(0), node_kinetic(0)) - node_kinetic(0));
  const int ended = side == Side::upper ? last : last - 1;
  for (int face = 1; face <= ended; ++face) {
    const bool at_chamber = side == Side::upper && face == last;
    const double h = 0.5 * (opened(face - 1) + opened(face)),
                 length = face_length(layout, face) * (at_chamber ? 0.5 : 1.0);
    const double area = 2 * pi * face_radius(layout, face) * h, u = q(face) / area;
    power += q(face) * gap_friction(law, h) * u * length;
    kinetic += area * length * kinetic_pressure(law, u);
    if (!law.convective) continue;
    const double before = node_kinetic(face - 1);
    if (at_chamber)
      power += q(face) * (drop_at_end(law, u, before) + before);
    else
      power +=
          q(face) * (convective_drop(law, u, before, node_kinetic(face)) - (node_kinetic(face) - before));
  }
  return power;
}

double passage_dissipation(const GapFlowLaw& law, const Passage& passage, const PassageLosses& losses,
                           double q, double& kinetic) {
  kinetic += 0.5 * law.density * passage.inertance * q * q;
  return q * passage_drop(law, passage, losses, q, 0.0);
}

double contact_energy(const ThinGapSettings& settings, double height) {
  const double onset = settings.film_thickness / 5, depth = settings.film_thickness - height;
  if (depth <= 0) return 0;
  if (depth < onset) return settings.contact_stiffness * depth * depth * depth / (6 * onset);
  const double past = depth - onset;
  return settings.contact_stiffness * (onset * onset / 6 + 0.5 * onset * past + 0.5 * past * past);
}

} // namespace

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
    law.stokes_layer =
        std::sqrt(scene.fluid.viscosity / scene.fluid.density / (pi * scene.operating_point.frequency));
  law.least_height = settings.film_thickness / 2;
  const auto& point = scene.operating_point;
  const double holder_speed = 2 * pi * point.frequency * std::abs(point.stroke_scale * point.stroke);
  law.turning_velocity = std::max(0.1 * holder_speed, 0.1); // cm/s; kinetic pressures there are negligible
  law.convective = scene.flow != FlowModel::stokes;
  return law;
}

FaceVelocities face_velocities(const ThinGapLayout& layout, const GapFlowLaw& law, const Eigen::VectorXd& x,
                               const Eigen::VectorXd& d) {
  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  FaceVelocities u{Eigen::VectorXd::Zero(at.nodes + 1), Eigen::VectorXd::Zero(at.nodes + 1)};
  for (const Side side : {Side::upper, Side::lower}) {
    const auto opened = [&](int node) {
      return open_height(law, rest_height(layout, side, node) + opening_sign(side) * d[at.deflection(node)]);
    };
    const int last = side == Side::upper ? layout.channel : at.nodes - 1;
    for (int face = 0; face <= last; ++face) {
      const double h = face == 0 ? opened(0) : 0.5 * (opened(face - 1) + opened(face));
      (side == Side::upper ? u.upper : u.lower)[face] =
          x[flow_at(at, side, face)] / (2 * pi * face_radius(layout, face) * h);
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

namespace {

template <bool derive>
void assemble_all(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                  BandMatrix* matrix) {
  residual.setZero(step.at.size());
  if (matrix) matrix->set_zero();
  assemble_gap<derive>(step, Side::upper, x, residual, matrix);
  assemble_gap<derive>(step, Side::lower, x, residual, matrix);
  assemble_passages<derive>(step, x, residual, matrix);
  assemble_plate<derive>(step, x, residual, matrix);
  assemble_contact<derive>(step, x, residual, matrix);
}

} // namespace

void assemble(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
              BandMatrix* matrix, double& holder_force) {
  if (matrix)
    assemble_all<true>(step, x, residual, matrix);
  else
    assemble_all<false>(step, x, residual, nullptr);
  holder_force = impose_holder(step, x, residual, matrix);
}

EnergyTerms thin_gap_energy(const ThinGapStep& step, const Eigen::VectorXd& x, double holder_force) {
  const auto& at = step.at;
  const auto& layout = *step.layout;
  const auto& law = step.law;
  const Eigen::VectorXd d = displacements(step, x);
  EnergyTerms terms;
  terms.holder = holder_force * x[at.deflection_rate(at.nodes - 1)];
  const double through_outlet = x[at.upper_flow(0)] + x[at.lower_flow(0)]; // inwards
  const double through_inlet = -(x[at.upper_flow(at.nodes)] + x[at.lower_flow(at.nodes)]);
  terms.opening = step.outlet_pressure * through_outlet;
  for (const Side side : {Side::upper, Side::lower})
    terms.viscous += gap_dissipation(step, side, x, d, terms.kinetic);
  terms.viscous += passage_dissipation(law, layout.outlet, channel_losses(law, step.scene->outlet),
                                       through_outlet, terms.kinetic);
  terms.viscous += passage_dissipation(law, layout.inlet, channel_losses(law, step.scene->inlet),
                                       through_inlet, terms.kinetic);
  terms.viscous +=
      passage_dissipation(law, layout.rim, rim_losses(law), x[at.lower_flow(at.nodes)], terms.kinetic);
  const auto node_of = [](const Eigen::VectorXd& values, int first) {
    return PlateNode<double>{values[first], values[first + 1], values[first + 2]};
  };
  for (int inner = 0; inner < layout.clamp; ++inner) {
    const auto forces = plate_forces<double>(
        plate_element(layout, inner), step.scene->membrane, step.scene->solid_model,
        {node_of(d, at.deflection(inner)), node_of(d, at.deflection(inner + 1))},
        {node_of(x, at.deflection_rate(inner)), node_of(x, at.deflection_rate(inner + 1))});
    terms.elastic += forces.elastic;
    terms.damping += forces.damping;
  }
  for (int node = 0; node < at.nodes; ++node) {
    const double area = node_area(layout, node), h = layout.thickness[node];
    const double mass = step.scene->membrane.density * h * area;
    const auto v = node_of(x, at.deflection_rate(node));
    terms.kinetic += 0.5 * mass * (v.w * v.w + v.u * v.u + h * h / 12 * v.theta * v.theta);
    if (node >= layout.channel) continue;
    const double w = d[at.deflection(node)];
    terms.elastic += area * (contact_energy(step.scene->thin_gap, upper_height(layout, node, w)) +
                             contact_energy(step.scene->thin_gap, lower_height(layout, node, w)));
  }
  return terms;
}

} // namespace undula
