#include "fom/thin_gap/step_energy.hpp"

#include <numbers>

#include "fom/thin_gap/contact_law.hpp"
#include "fom/thin_gap/step_terms.hpp"

namespace undula::fom {

namespace {

constexpr double pi = std::numbers::pi;

/// Power that flow loses between two places, and kinetic energy of what lies between.
double gap_dissipation(const ThinGapStep& step, GapSide side, const Eigen::VectorXd& x,
                       const Eigen::VectorXd& d, double& kinetic) {
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
  const int ended = side == GapSide::upper ? last : last - 1;
  for (int face = 1; face <= ended; ++face) {
    const bool at_chamber = side == GapSide::upper && face == last;
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

} // namespace

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
  for (const GapSide side : {GapSide::upper, GapSide::lower})
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

} // namespace undula::fom
