#include "training/reduction/projection.hpp"

#include "fom/scene/operating_point.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {

rom::Operators project(const PreparedScene& prepared, const Bases& bases) {
  const auto& disc = prepared.disc;
  const auto& full = prepared.operators;
  for (const auto& [name, condition] : disc.problem.boundary)
    if (condition.kind == BoundaryCondition<2>::Kind::opening &&
        condition.opening == OpeningCondition::static_pressure)
      throw InputError("the reduced model needs openings whose condition is a polynomial of the velocity",
                       "static-pressure at '" + name + "'", "total-pressure", "section [model] of the scene");
  if (disc.problem.stabilisation.velocity_scale != VelocityScale::reference)
    throw InputError("the reduced model needs penalties that do not depend on the flow", "local", "reference",
                     "stabilisation.velocity_scale");
  rom::Operators reduced;
  reduced.velocity_modes = static_cast<int>(bases.velocity.cols());
  reduced.supremizer_modes = bases.supremizers;
  reduced.pressure_modes = static_cast<int>(bases.pressure.cols());
  reduced.displacement_modes = static_cast<int>(bases.displacement.cols());
  Eigen::MatrixXd basis(disc.unknowns(),
                        reduced.velocity_modes + reduced.pressure_modes + reduced.displacement_modes);
  basis << bases.velocity, bases.pressure, bases.displacement;

  SparseMatrix linear = full.physical + full.stabilisation;
  linear = linear + full.damping;
  const Eigen::VectorXd lifting = imposed_lifting(disc);
  reduced.mass = basis.transpose() * (full.mass * basis);
  reduced.linear = basis.transpose() * (linear * basis);
  reduced.stiffness = bases.displacement.transpose() * (full.stiffness * bases.displacement);
  reduced.imposed_mass = basis.transpose() * (full.mass * lifting);
  reduced.imposed_linear = basis.transpose() * (linear * lifting);
  reduced.imposed_stiffness = basis.transpose() * (full.stiffness * lifting);
  const auto& outlet = full.openings.at(outlet_name);
  const auto& inlet = full.openings.at(inlet_name);
  reduced.head = basis.transpose() * outlet;
  reduced.outflow = bases.velocity.transpose() * outlet;
  reduced.inflow = -(bases.velocity.transpose() * inlet);

  for (int k = 0; k < reduced.velocity_modes; ++k) {
    if (disc.problem.flow == FlowModel::stokes) {
      reduced.convection.emplace_back(Eigen::MatrixXd::Zero(reduced.velocity_modes, reduced.velocity_modes));
      continue;
    }
    Triplets entries;
    const Eigen::VectorXd convecting = bases.velocity.col(k);
    visit_convection(disc, full, convecting,
                     [&](int row, int column, double value) { entries.emplace_back(row, column, value); });
    reduced.convection.emplace_back(bases.velocity.transpose() *
                                    (compress(disc.unknowns(), entries) * bases.velocity));
  }
  const auto& probes = prepared.observation.probes;
  reduced.envelope = probes.axial * bases.displacement.bottomRows(probes.axial.cols());
  reduced.envelope_imposed = probes.axial * lifting.tail(probes.axial.cols());
  reduced.envelope_radius = Eigen::Map<const Eigen::VectorXd>(
      probes.radius.data(), static_cast<Eigen::Index>(probes.radius.size()));
  return reduced;
}

} // namespace undula::training
