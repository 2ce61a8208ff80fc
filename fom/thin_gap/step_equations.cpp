#include "fom/thin_gap/step_equations.hpp"

#include <numbers>
#include <unsupported/Eigen/AutoDiff>

#include "fom/actuator/holder_terms.hpp"
#include "fom/thin_gap/contact_law.hpp"
#include "fom/thin_gap/step_terms.hpp"

namespace undula::fom {

namespace {

constexpr double pi = std::numbers::pi;

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
Number height(const ThinGapStep& step, GapSide side, int node, const Number& v) {
  const Number w = deflection(step, node, v);
  return open_height(step.law, Number(rest_height(*step.layout, side, node) + opening_sign(side) * w));
}

template <typename Number>
Number time_derivative(const ThinGapStep& step, const Number& y, double history) {
  return Number((step.alpha[0] * y + history) / step.dt);
}

double u_history(const ThinGapStep& step, GapSide side, int face) {
  return (side == GapSide::upper ? step.upper_u_history : step.lower_u_history)[face];
}

/// Faces 1 .. last - 1 of a gap: momentum between two nodes.
template <typename Number>
Number inner_momentum(const ThinGapStep& step, GapSide side, int face, const Number& q_before,
                      const Number& q, const Number& q_after, const Number& p_inner, const Number& p_outer,
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
  const Number rate = time_derivative(step, u, u_history(step, GapSide::upper, face));
  return Number(0.5 * face_length(layout, face) *
                    (law.density * law.momentum_factor * rate + gap_friction(law, h) * u) +
                p_chamber - p_gap + drop_at_end(law, u, Number(kinetic_pressure(law, u_inner))));
}

template <bool derive>
void assemble_gap(const ThinGapStep& step, GapSide side, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
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
  if (side == GapSide::upper) {
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
                                (4 * pi * layout.radius[last] * height(step, GapSide::lower, last, y[4]))));
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

/// What the actuator makes of the holder at velocity v: mass, resistance and voltage.
void add_actuator(const ThinGapStep& step, double v, HolderEquation& holder) {
  const int last = step.at.nodes - 1;
  HolderMotion motion;
  motion.rate = step.alpha[0] / step.dt;
  motion.velocity = v;
  motion.displacement = (step.dt * v + step.d_history[step.at.deflection(last)]) / step.alpha[0];
  motion.acceleration = time_derivative(step, v, step.x_history[step.at.deflection_rate(last)]);
  const HolderTerms terms = holder_terms(step.scene->actuator, step.voltage, motion);
  holder.residual = holder.force + terms.force;
  holder.by_velocity = terms.by_velocity;
}

/// Replaces the plate's equations in the holder by its motion, and sums up what they were.
void join_holder(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                 BandMatrix* matrix, HolderEquation& holder) {
  const auto& at = step.at;
  const bool free = holder_is_free(step);
  const double v = holder_velocity(step, x);
  holder.force = 0;
  if (matrix && free) holder.row.setZero(at.size());
  for (int node = step.layout->clamp; node < at.nodes; ++node) {
    holder.force += residual[at.deflection_rate(node)];
    if (matrix && free) matrix->add_row_to(at.deflection_rate(node), holder.row);
    for (int k = 0; k < 3; ++k) {
      const int row = at.deflection_rate(node) + k;
      const double target = k == 0 ? step.holder_displacement : 0.0;
      residual[row] =
          k == 0 && free
              ? x[row] - v
              : x[row] - (step.alpha[0] * target - step.d_history[at.deflection(node) + k]) / step.dt;
      if (matrix) {
        matrix->clear_row(row);
        (*matrix)(row, row) = 1;
      }
    }
  }
  if (free) add_actuator(step, v, holder);
}

template <bool derive>
void assemble_all(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                  BandMatrix* matrix) {
  residual.setZero(step.at.size());
  if (matrix) matrix->set_zero();
  assemble_gap<derive>(step, GapSide::upper, x, residual, matrix);
  assemble_gap<derive>(step, GapSide::lower, x, residual, matrix);
  assemble_passages<derive>(step, x, residual, matrix);
  assemble_plate<derive>(step, x, residual, matrix);
  assemble_contact<derive>(step, x, residual, matrix);
}

} // namespace

double holder_velocity(const ThinGapStep& step, const Eigen::VectorXd& x) {
  return x[step.at.deflection_rate(step.at.nodes - 1)];
}

void assemble(const ThinGapStep& step, const Eigen::VectorXd& x, Eigen::VectorXd& residual,
              BandMatrix* matrix, HolderEquation& holder) {
  if (matrix)
    assemble_all<true>(step, x, residual, matrix);
  else
    assemble_all<false>(step, x, residual, nullptr);
  join_holder(step, x, residual, matrix, holder);
}

} // namespace undula::fom
