#include "training/reduction/drawn_bases.hpp"

#include "fom/output/level_view.hpp"
#include "fom/output/visual_mesh.hpp"

namespace undula::training {
namespace {

rom::DrawnMesh drawn_mesh(const FieldMesh<2>& mesh) {
  rom::DrawnMesh drawn{Eigen::MatrixXd(mesh.points.size(), 2), Eigen::MatrixXi(mesh.cells.size(), 3)};
  Eigen::Index row = 0;
  for (const auto& point : mesh.points) drawn.points.row(row++) = point.transpose();
  row = 0;
  for (const auto& cell : mesh.cells) drawn.cells.row(row++) << cell[0], cell[1], cell[2];
  return drawn;
}

/// Every mode as the field `name` of a state that holds it alone.
template <class FieldsOfMode>
Eigen::MatrixXd drawn_modes(const Eigen::MatrixXd& modes, const std::string& name, Eigen::Index rows,
                            const FieldsOfMode& fields_of) {
  Eigen::MatrixXd drawn(rows, modes.cols());
  for (Eigen::Index k = 0; k < modes.cols(); ++k) {
    State state;
    state.x[0] = state.d[0] = modes.col(k);
    const auto fields = fields_of(state);
    const auto& values = field_named(fields, name).values;
    drawn.col(k) = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }
  return drawn;
}

} // namespace

rom::FieldBases drawn_bases(const Discretisation<2>& disc, const Bases& bases) {
  const FluidPicture<2> fluid = fluid_picture(disc);
  rom::FieldBases drawn{drawn_mesh(fluid.mesh), drawn_mesh(solid_picture(disc)), {}, {}, {}, {}};
  const Eigen::Index n = drawn.fluid.points.rows(), k = drawn.solids.points.rows();
  const auto of_fluid = [&](const State& state) { return fluid_fields(disc, fluid, state); };
  const auto of_solids = [&](const State& state) { return solid_fields(disc, state); };
  drawn.velocity = drawn_modes(bases.velocity, "velocity", 2 * n, of_fluid);
  drawn.pressure = drawn_modes(bases.pressure, "pressure", n, of_fluid);
  drawn.displacement = drawn_modes(bases.displacement, "displacement", 2 * k, of_solids);
  drawn.holder = drawn_modes(imposed_lifting(disc), "displacement", 2 * k, of_solids);
  return drawn;
}

} // namespace undula::training
