#include "fom/mapping/domain_extension.hpp"

#include <algorithm>
#include <cmath>

#include "fom/mapping/map_penalties.hpp"
#include "fom/mapping/nodes_at_rest.hpp"
#include "fom/mapping/skin_elasticity.hpp"
#include "fom/mapping/weighted_laplace.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// Mean thickness of the solids: twice their volume over the area of their skins (plain measures), cm.
template <int dim>
double mean_thickness(const Discretisation<dim>& disc) {
  double volume = 0, skin = 0;
  for (const auto& body : disc.problem.solids) {
    for (std::size_t cell = 0; cell < body.mesh.cells.size(); ++cell)
      volume += cell_measure(body.mesh, static_cast<int>(cell));
    for (const auto& facet : build_facet_table(body.mesh).facets)
      if (facet.cells[1] < 0) skin += facet_measure(body.mesh, facet);
  }
  return skin > 0 ? 2 * volume / skin : 0.0;
}

void expect_factored(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factors) {
  if (factors.info() != Eigen::Success)
    throw NumericsError("the extension of the solids' displacement into the fluid could not be factored",
                        "preparing the map of the domain", "another mesh size near the solids");
}

/// Weights |grad reach|^(p - 2) by part from the slopes of the iterate, scaled and kept within bounds. Half
/// by the part's own slope, half by its neighbours' (geometric means): with its own alone the iteration may
/// end in a pattern of stiff and soft elements, with the neighbours' alone the element at a corner stays too
/// steep.
template <int dim>
std::vector<double> slope_weights(const Discretisation<dim>& disc,
                                  std::span<const PartGeometry<dim>> geometries, const Point<dim>& axes,
                                  const Eigen::VectorXd& reach, double exponent) {
  const std::size_t parts = disc.cut.parts.size();
  std::vector<double> slopes(parts), logarithms(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    Point<dim> slope = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a)
      slope += reach[disc.fluid_nodes.part_dofs[p][a]] * geometries[p].reference_gradients.col(a);
    slopes[p] = std::sqrt(slope.cwiseAbs2().dot(axes));
  }
  auto sorted = slopes;
  const auto steep = sorted.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(parts - 1));
  std::nth_element(sorted.begin(), steep, sorted.end());
  // Bounds on the weights, 1e-8 .. 1e6, whatever the exponent.
  const double low = std::pow(1e-8, 1 / (exponent - 2)), high = std::pow(1e6, 1 / (exponent - 2));
  const std::size_t nodes = disc.fluid_nodes.dof_point.size();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(nodes), count = Eigen::VectorXd::Zero(nodes);
  for (std::size_t p = 0; p < parts; ++p) {
    logarithms[p] = std::log(std::clamp(slopes[p] / *steep, low, high));
    for (const int node : disc.fluid_nodes.part_dofs[p]) {
      sum[node] += logarithms[p];
      count[node] += 1;
    }
  }
  std::vector<double> weights(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    double mean = 0;
    for (const int node : disc.fluid_nodes.part_dofs[p]) mean += sum[node] / count[node] / (dim + 1);
    weights[p] = std::exp(0.5 * (exponent - 2) * (logarithms[p] + mean));
  }
  return weights;
}

/// See domain_extension.hpp. Reweighted least squares with damping 1 / (p - 1), which is Newton's step along
/// the slope, for p = 4, 8, ... up to the exponent.
template <int dim>
Eigen::VectorXd reach_of(const Discretisation<dim>& disc, std::span<const PartGeometry<dim>> geometries,
                         int component, const ExtensionSettings& settings) {
  const auto at_rest = nodes_at_rest(disc, component);
  Point<dim> axes = Point<dim>::Constant(settings.shear_weight);
  axes[component] = 1;
  std::vector<double> weights(disc.cut.parts.size(), 1.0);
  typename DomainExtension<dim>::Factors factors;
  bool analysed = false;
  const auto solve = [&] {
    auto problem = weighted_laplace<dim>(disc, geometries, weights, axes);
    for (Eigen::Index node = 0; node < problem.rhs.size(); ++node)
      if (at_rest[node]) problem.rhs[node] = 0;
    hold(at_rest, problem.matrix);
    keep_regular(problem.matrix);
    const Eigen::SparseMatrix<double> matrix = problem.matrix;
    if (!analysed) factors.analyzePattern(matrix);
    analysed = true;
    factors.factorize(matrix);
    expect_factored(factors);
    return Eigen::VectorXd(factors.solve(problem.rhs));
  };
  Eigen::VectorXd reach = solve();
  for (double exponent = 4; settings.exponent > 2; exponent = std::min(2 * exponent, settings.exponent)) {
    for (int sweep = 0; sweep < settings.sweeps; ++sweep) {
      weights = slope_weights<dim>(disc, geometries, axes, reach, exponent);
      reach += (solve() - reach) / (exponent - 1);
    }
    if (exponent >= settings.exponent) break;
  }
  return reach;
}

} // namespace

template <int dim>
DomainExtension<dim> prepare_extension(const Discretisation<dim>& disc, const ExtensionSettings& settings) {
  DomainExtension<dim> extension;
  const auto geometries = part_geometries(disc);
  auto problem =
      skin_elasticity<dim>(disc, geometries, settings.smoothing * mean_thickness(disc), map_skin_penalty);
  keep_regular(problem.matrix);
  extension.smooth =
      std::make_unique<typename DomainExtension<dim>::Factors>(Eigen::SparseMatrix<double>(problem.matrix));
  expect_factored(*extension.smooth);
  extension.data = problem.data;
  for (int c = 0; c < dim; ++c) extension.reach[c] = reach_of<dim>(disc, geometries, c, settings);
  return extension;
}

template <int dim>
std::vector<Point<dim>> extend(const DomainExtension<dim>& extension,
                               const Eigen::VectorXd& solid_displacement) {
  const Eigen::VectorXd smooth = extension.smooth->solve(extension.data * solid_displacement);
  std::vector<Point<dim>> displacement(extension.reach[0].size());
  for (std::size_t node = 0; node < displacement.size(); ++node)
    for (int c = 0; c < dim; ++c)
      displacement[node][c] = extension.reach[c][node] * smooth[static_cast<Eigen::Index>(node) * dim + c];
  return displacement;
}

template struct DomainExtension<2>;
template DomainExtension<2> prepare_extension(const Discretisation<2>&, const ExtensionSettings&);
template std::vector<Point<2>> extend(const DomainExtension<2>&, const Eigen::VectorXd&);

template struct DomainExtension<3>;
template DomainExtension<3> prepare_extension(const Discretisation<3>&, const ExtensionSettings&);
template std::vector<Point<3>> extend(const DomainExtension<3>&, const Eigen::VectorXd&);

} // namespace undula::fom
