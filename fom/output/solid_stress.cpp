#include "fom/output/solid_stress.hpp"

#include <cmath>

#include "fom/materials/solid_laws.hpp"

namespace undula::fom {

namespace {

/// d displacement / dX with the hoop; on the axis, where u_r / r is 0 / 0, its limit.
template <int dim>
Eigen::Matrix3d gradient_at(const Discretisation<dim>& disc, int solid, int cell,
                            const Eigen::Matrix<double, dim + 1, 1>& lambda, const Eigen::VectorXd& d) {
  const auto& mesh = disc.problem.solids[solid].mesh;
  const auto& nodes = disc.solid_spaces[solid].cell_nodes[cell];
  const auto shape = quadratic_values<dim>(lambda);
  const auto slopes = quadratic_gradients<dim>(lambda, barycentric_gradients(mesh, cell));
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  double radius = 0, radial = 0;
  for (int k = 0; k < QuadraticSpace<dim>::nodes_per_cell; ++k) {
    const Point<dim> value = d.template segment<dim>(disc.solid_unknown(solid, nodes[k], 0));
    H.template topLeftCorner<dim, dim>() += value * slopes.col(k).transpose();
    radius += shape[k] * disc.solid_spaces[solid].nodes[nodes[k]][0];
    radial += shape[k] * value[0];
  }
  if (disc.problem.space == Space::axisymmetric) H(2, 2) = radius > 0 ? radial / radius : H(0, 0);
  return H;
}

double von_mises(SolidModel model, const LameConstants& lame, const Eigen::Matrix3d& H) {
  Eigen::Matrix3d stress;
  if (model == SolidModel::linear) {
    const Eigen::Matrix3d strain = 0.5 * (H + H.transpose());
    stress = 2 * lame.mu * strain + lame.lambda * strain.trace() * Eigen::Matrix3d::Identity();
  } else {
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + H;
    stress =
        F * stress_tensor<3>(material_response<3>(model, lame, H).stress) * F.transpose() / F.determinant();
  }
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5 * deviator.squaredNorm());
}

} // namespace

template <int dim>
std::vector<double> von_mises_stress(const Discretisation<dim>& disc, const Eigen::VectorXd& d) {
  std::vector<double> all;
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const int solid = static_cast<int>(s);
    const auto& body = disc.problem.solids[s];
    const auto& space = disc.solid_spaces[s];
    const auto lame = lame_constants(body.properties);
    std::vector<double> sum(space.nodes.size(), 0.0), cells(space.nodes.size(), 0.0);
    for (std::size_t c = 0; c < space.cell_nodes.size(); ++c) {
      int local = 0;
      const auto add = [&](const Eigen::Matrix<double, dim + 1, 1>& lambda) {
        const auto node = static_cast<std::size_t>(space.cell_nodes[c][local++]);
        sum[node] +=
            von_mises(body.model, lame, gradient_at<dim>(disc, solid, static_cast<int>(c), lambda, d));
        cells[node] += 1;
      };
      using Barycentric = Eigen::Matrix<double, dim + 1, 1>;
      for (int a = 0; a <= dim; ++a) add(Barycentric::Unit(a));
      for (int a = 0; a <= dim; ++a)
        for (int b = a + 1; b <= dim; ++b) add(0.5 * (Barycentric::Unit(a) + Barycentric::Unit(b)));
    }
    for (std::size_t i = 0; i < sum.size(); ++i) all.push_back(sum[i] / cells[i]);
  }
  return all;
}

template std::vector<double> von_mises_stress(const Discretisation<2>&, const Eigen::VectorXd&);

template std::vector<double> von_mises_stress(const Discretisation<3>&, const Eigen::VectorXd&);

} // namespace undula::fom
