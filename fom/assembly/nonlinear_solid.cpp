#include "fom/assembly/nonlinear_solid.hpp"

#include <algorithm>
#include <limits>

namespace undula::fom {

namespace {

constexpr int quadrature_degree = 5; // the energy of the quadratic law in P2 times r: exact

/// d(values)/dX with the hoop.
template <int dim>
Eigen::Matrix3d gradient_of(const typename CellResponse<dim>::Values& values,
                            const QuadraticGradients<dim>& g, const QuadraticValues<dim>& shape_by_r) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (int k = 0; k < QuadraticSpace<dim>::nodes_per_cell; ++k) {
    H.template topLeftCorner<dim, dim>() += values.template segment<dim>(k * dim) * g.col(k).transpose();
    if constexpr (dim == 2) H(2, 2) += values[k * dim] * shape_by_r[k]; // hoop; zero weights in plane space
  }
  return H;
}

/// Columns: sym(A^T dF) of unit displacements.
template <int dim>
auto strain_columns(const Eigen::Matrix3d& A, const QuadraticGradients<dim>& g,
                    const QuadraticValues<dim>& shape_by_r) {
  Eigen::Matrix<double, symmetric_size<dim>, CellResponse<dim>::size> columns;
  for (int k = 0; k < QuadraticSpace<dim>::nodes_per_cell; ++k)
    for (int c = 0; c < dim; ++c) {
      Eigen::Matrix3d dF = Eigen::Matrix3d::Zero();
      dF.template block<1, dim>(c, 0) = g.col(k).transpose();
      if (dim == 2 && c == 0) dF(2, 2) = shape_by_r[k];
      columns.col(k * dim + c) = strain_entries<dim>(A.transpose() * dF);
    }
  return columns;
}

} // namespace

template <int dim>
bool has_nonlinear_solid(const Discretisation<dim>& disc) {
  return std::any_of(disc.problem.solids.begin(), disc.problem.solids.end(),
                     [](const auto& body) { return is_nonlinear(body.model); });
}

template <int dim>
std::vector<SolidCell> nonlinear_cells(const Discretisation<dim>& disc, const Share& share) {
  std::vector<SolidCell> cells;
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    if (!is_nonlinear(disc.problem.solids[s].model)) continue;
    const int solid = static_cast<int>(s);
    for (std::size_t c = 0; c < disc.solid_spaces[s].cell_nodes.size(); ++c)
      if (disc.cell_weight(solid, static_cast<int>(c)) > 0 &&
          share.has(disc.solid_unknown(solid, disc.solid_spaces[s].cell_nodes[c][0], 0)))
        cells.push_back({solid, static_cast<int>(c)});
  }
  return cells;
}

template <int dim>
std::array<int, dim * QuadraticSpace<dim>::nodes_per_cell> cell_unknowns(const Discretisation<dim>& disc,
                                                                         const SolidCell& cell) {
  std::array<int, dim * QuadraticSpace<dim>::nodes_per_cell> unknowns;
  int next = 0;
  for (const int node : disc.solid_spaces[cell.solid].cell_nodes[cell.cell])
    for (int c = 0; c < dim; ++c) unknowns[next++] = disc.solid_unknown(cell.solid, node, c);
  return unknowns;
}

template <int dim>
CellResponse<dim> cell_response(const Discretisation<dim>& disc, const SolidCell& cell,
                                const typename CellResponse<dim>::Values& d,
                                const typename CellResponse<dim>::Values& v, bool derive,
                                const typename CellResponse<dim>::Values* before) {
  static const auto rule = reference_rule<dim>(quadrature_degree);
  constexpr int nodes = QuadraticSpace<dim>::nodes_per_cell;
  const auto& body = disc.problem.solids[cell.solid];
  const auto lame = lame_constants(body.properties);
  const double damping_time = body.properties.damping_time;
  const bool hoop = disc.problem.space == Space::axisymmetric;
  const Measure measure = measure_of(disc.problem.space);
  const double volume = cell_measure(body.mesh, cell.cell), weight = disc.cell_weight(cell.solid, cell.cell);
  const auto barycentric = barycentric_gradients(body.mesh, cell.cell);

  CellResponse<dim> response;
  response.smallest_volume_ratio = std::numeric_limits<double>::infinity();
  response.elastic.setZero();
  response.viscous.setZero();
  response.by_d.setZero();
  response.by_v.setZero();
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    const auto& lambda = rule.barycentric[q];
    Point<dim> x = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a) x += lambda[a] * body.mesh.points[body.mesh.cells[cell.cell][a]];
    const double w = weight * rule.weights[q] * volume * measure(x[0]);
    const auto g = quadratic_gradients<dim>(lambda, barycentric);
    const QuadraticValues<dim> shape_by_r =
        hoop ? QuadraticValues<dim>(quadratic_values<dim>(lambda) / x[0]) : QuadraticValues<dim>::Zero();

    const Eigen::Matrix3d H = gradient_of<dim>(d, g, shape_by_r), F = Eigen::Matrix3d::Identity() + H;
    Eigen::Matrix3d H_before;
    if (before) H_before = gradient_of<dim>(*before, g, shape_by_r);
    const auto material = material_response<dim>(body.model, lame, H, before ? &H_before : nullptr);
    const auto B = strain_columns<dim>(F, g, shape_by_r);
    response.energy += w * material.energy;
    response.smallest_volume_ratio = std::min(response.smallest_volume_ratio, F.determinant());
    response.elastic += w * (B.transpose() * material.stress);
    SymmetricTensor<dim> stress = material.geometric_stress;
    if (damping_time > 0) {
      const Eigen::Matrix3d rate = gradient_of<dim>(v, g, shape_by_r);
      const MaterialTangent<dim> viscosity = damping_time * linear_tangent<dim>(lame);
      const SymmetricTensor<dim> viscous = viscosity * strain_entries<dim>(F.transpose() * rate);
      stress += viscous;
      response.viscous += w * (B.transpose() * viscous);
      if (derive) {
        const Eigen::Matrix<double, CellResponse<dim>::size, symmetric_size<dim>> BC =
            w * (B.transpose() * viscosity);
        response.by_v += BC * B;
        response.by_d += BC * strain_columns<dim>(rate, g, shape_by_r);
      }
    }
    if (!derive) continue;
    response.by_d += w * (B.transpose() * (material.tangent * B));
    // Stress on the second derivative of the strain, sym(dF_i^T dF_j): the same for every component.
    const Eigen::Matrix3d S = stress_tensor<dim>(stress);
    const auto Sg = (S.template topLeftCorner<dim, dim>() * g).eval();
    for (int i = 0; i < nodes; ++i)
      for (int j = 0; j < nodes; ++j) {
        const double along = w * g.col(i).dot(Sg.col(j));
        for (int c = 0; c < dim; ++c) response.by_d(i * dim + c, j * dim + c) += along;
        response.by_d(i * dim, j * dim) += w * S(2, 2) * shape_by_r[i] * shape_by_r[j];
      }
  }
  return response;
}

template <int dim>
SolidResponse<dim> solid_response(const Discretisation<dim>& disc, const std::vector<SolidCell>& cells,
                                  const Eigen::VectorXd& d, const Eigen::VectorXd& v, const SolidRates& rates,
                                  bool derive, const Eigen::VectorXd* before) {
  SolidResponse<dim> sum;
  sum.smallest_volume_ratio = std::numeric_limits<double>::infinity();
  sum.elastic = sum.viscous = Eigen::VectorXd::Zero(disc.unknowns());
  for (const auto& cell : cells) {
    const auto unknowns = cell_unknowns(disc, cell);
    using Values = typename CellResponse<dim>::Values;
    Values d_before;
    if (before) d_before = (*before)(unknowns);
    const auto local = cell_response<dim>(disc, cell, Values(d(unknowns)), Values(v(unknowns)), derive,
                                          before ? &d_before : nullptr);
    sum.energy += local.energy;
    sum.smallest_volume_ratio = std::min(sum.smallest_volume_ratio, local.smallest_volume_ratio);
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      sum.elastic[unknowns[i]] += local.elastic[static_cast<Eigen::Index>(i)];
      sum.viscous[unknowns[i]] += local.viscous[static_cast<Eigen::Index>(i)];
    }
    if (derive) sum.tangents.push_back(rates.d * local.by_d + rates.v * local.by_v);
  }
  return sum;
}

template <int dim>
void add_tangent_product(const Discretisation<dim>& disc, const std::vector<SolidCell>& cells,
                         const SolidResponse<dim>& response, const Eigen::VectorXd& x, bool absolute,
                         Eigen::VectorXd& sum) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto unknowns = cell_unknowns(disc, cells[k]);
    typename CellResponse<dim>::Values local = x(unknowns);
    if (absolute)
      local = response.tangents[k].cwiseAbs() * local.cwiseAbs().eval();
    else
      local = response.tangents[k] * local.eval();
    for (std::size_t i = 0; i < unknowns.size(); ++i) sum[unknowns[i]] += local[static_cast<Eigen::Index>(i)];
  }
}

template bool has_nonlinear_solid(const Discretisation<2>&);
template std::vector<SolidCell> nonlinear_cells(const Discretisation<2>&, const Share&);
template std::array<int, 12> cell_unknowns(const Discretisation<2>&, const SolidCell&);
template CellResponse<2> cell_response<2>(const Discretisation<2>&, const SolidCell&,
                                          const CellResponse<2>::Values&, const CellResponse<2>::Values&,
                                          bool, const CellResponse<2>::Values*);
template SolidResponse<2> solid_response(const Discretisation<2>&, const std::vector<SolidCell>&,
                                         const Eigen::VectorXd&, const Eigen::VectorXd&, const SolidRates&,
                                         bool, const Eigen::VectorXd*);
template void add_tangent_product(const Discretisation<2>&, const std::vector<SolidCell>&,
                                  const SolidResponse<2>&, const Eigen::VectorXd&, bool, Eigen::VectorXd&);

template bool has_nonlinear_solid(const Discretisation<3>&);
template std::vector<SolidCell> nonlinear_cells(const Discretisation<3>&, const Share&);
template std::array<int, 30> cell_unknowns(const Discretisation<3>&, const SolidCell&);
template CellResponse<3> cell_response<3>(const Discretisation<3>&, const SolidCell&,
                                          const CellResponse<3>::Values&, const CellResponse<3>::Values&,
                                          bool, const CellResponse<3>::Values*);
template SolidResponse<3> solid_response(const Discretisation<3>&, const std::vector<SolidCell>&,
                                         const Eigen::VectorXd&, const Eigen::VectorXd&, const SolidRates&,
                                         bool, const Eigen::VectorXd*);
template void add_tangent_product(const Discretisation<3>&, const std::vector<SolidCell>&,
                                  const SolidResponse<3>&, const Eigen::VectorXd&, bool, Eigen::VectorXd&);

} // namespace undula::fom
