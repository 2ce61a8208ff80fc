#include "fom/mapping/unfolding.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fom/mapping/nodes_at_rest.hpp"
#include "fom/mapping/skin_elasticity.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

template <int dim>
using Gradient = Eigen::Matrix<double, dim, dim + 1>;

template <int dim>
Eigen::Matrix<double, dim, dim> deformation(const typename Unfolding<dim>::Element& element,
                                            const Eigen::VectorXd& map) {
  Eigen::Matrix<double, dim, dim> F = Eigen::Matrix<double, dim, dim>::Identity();
  for (int a = 0; a <= dim; ++a)
    F += map.segment<dim>(element.nodes[a] * dim) * element.gradients.col(a).transpose();
  return F;
}

/// J by element.
template <int dim>
Eigen::VectorXd volume_ratios(const Unfolding<dim>& unfolding, const Eigen::VectorXd& map) {
  Eigen::VectorXd ratios(static_cast<Eigen::Index>(unfolding.elements.size()));
  for (std::size_t e = 0; e < unfolding.elements.size(); ++e)
    ratios[static_cast<Eigen::Index>(e)] = deformation<dim>(unfolding.elements[e], map).determinant();
  return ratios;
}

double barrier(const UnfoldingSettings& settings, double ratio) {
  if (ratio >= settings.threshold) return 0;
  const double logarithm = std::log(ratio / settings.threshold);
  return 0.5 * settings.weight * logarithm * logarithm;
}

/// Gradient of the barrier, and its curvature with what bends J left out, added to both.
template <int dim>
void add_barrier(const Unfolding<dim>& unfolding, const Eigen::VectorXd& map, Eigen::VectorXd& gradient,
                 typename Unfolding<dim>::Matrix& curvature) {
  const auto& settings = unfolding.settings;
  for (const auto& element : unfolding.elements) {
    const auto F = deformation<dim>(element, map);
    const double ratio = F.determinant();
    if (ratio >= settings.threshold) continue;
    const double logarithm = std::log(ratio / settings.threshold), scale = settings.weight * element.measure;
    const double slope = scale * logarithm / ratio, bend = scale * (1 - logarithm) / (ratio * ratio);
    // dJ / d(node a) = J F^-T grad(lambda_a)
    const Gradient<dim> by_node = ratio * F.inverse().transpose() * element.gradients;
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c < dim; ++c) {
        const int row = element.nodes[a] * dim + c;
        if (unfolding.held[row]) continue;
        gradient[row] += slope * by_node(c, a);
        for (int b = 0; b <= dim; ++b)
          for (int d = 0; d < dim; ++d) {
            const int column = element.nodes[b] * dim + d;
            if (!unfolding.held[column])
              curvature.coeffRef(row, column) += bend * by_node(c, a) * by_node(d, b);
          }
      }
  }
}

} // namespace

template <int dim>
Unfolding<dim> prepare_unfolding(const Discretisation<dim>& disc, const UnfoldingSettings& settings) {
  Unfolding<dim> unfolding;
  unfolding.settings = settings;
  const auto geometries = part_geometries(disc);
  auto elastic = skin_elasticity<dim>(disc, geometries, 0.0, settings.skin_penalty).matrix;
  const auto size = static_cast<std::size_t>(elastic.rows());
  unfolding.held.assign(size, 0);
  for (int c = 0; c < dim; ++c) {
    const auto at_rest = nodes_at_rest(disc, c);
    for (std::size_t node = 0; node < at_rest.size(); ++node) unfolding.held[node * dim + c] = at_rest[node];
  }
  hold(unfolding.held, elastic);
  keep_regular(elastic);
  unfolding.elastic = elastic;
  unfolding.factors = std::make_unique<typename Unfolding<dim>::Factors>();
  unfolding.factors->analyzePattern(unfolding.elastic);
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    auto& element = unfolding.elements.emplace_back();
    for (int a = 0; a <= dim; ++a) element.nodes[a] = disc.fluid_nodes.part_dofs[p][a];
    element.gradients = geometries[p].reference_gradients;
    element.measure = cell_measure(disc.cut.mesh, disc.cut.parts[p].cell);
  }
  return unfolding;
}

template <int dim>
UnfoldedMap<dim> unfold(const Unfolding<dim>& unfolding, const std::vector<Point<dim>>& target,
                        const std::function<std::vector<Eigen::VectorXd>()>& starts) {
  const auto& settings = unfolding.settings;
  UnfoldedMap<dim> result;
  result.displacement = target;
  const Eigen::VectorXd wanted = in_a_row<dim>(target);
  Eigen::VectorXd ratios = volume_ratios(unfolding, wanted);
  result.smallest_ratio = ratios.minCoeff();
  if (result.smallest_ratio >= settings.threshold) return result;

  // The start that is farthest from a fold.
  Eigen::VectorXd map, at_start;
  for (const Eigen::VectorXd& candidate : starts()) {
    const Eigen::VectorXd volumes = volume_ratios(unfolding, candidate);
    if (map.size() > 0 && volumes.minCoeff() <= at_start.minCoeff()) continue;
    map = candidate;
    at_start = volumes;
  }
  Eigen::Index worst = 0;
  if (map.size() == 0 || !(at_start.minCoeff(&worst) > 0))
    throw NumericsError(
        "the map of the fluid's domain folds",
        "no start without a fold, smallest volume ratio " +
            (map.size() > 0 ? std::to_string(at_start[worst]) + " of element " + std::to_string(worst)
                            : std::string("unknown")),
        "coupling = \"explicit\", which cuts anew, or a smaller time step");
  ratios = at_start;
  const auto energy = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& volumes) {
    const Eigen::VectorXd correction = at - wanted;
    double sum = 0.5 * correction.dot(unfolding.elastic * correction);
    for (std::size_t e = 0; e < unfolding.elements.size(); ++e)
      sum += unfolding.elements[e].measure * barrier(settings, volumes[static_cast<Eigen::Index>(e)]);
    return sum;
  };
  // Newton's step on a barrier makes a small J twice as large at best: so J may not fall by much at once, and
  // the iteration is not over while one still grows.
  constexpr double least_part = 0.2, settled = 0.1;
  const double scale = wanted.template lpNorm<Eigen::Infinity>();
  double now = energy(map, ratios);
  typename Unfolding<dim>::Matrix curvature;
  for (result.iterations = 1;; ++result.iterations) {
    if (result.iterations > settings.max_iterations)
      throw NumericsError("the map of the fluid's domain does not settle",
                          std::to_string(settings.max_iterations) + " iterations, smallest volume ratio " +
                              std::to_string(ratios.minCoeff()),
                          "a smaller time step");
    curvature = unfolding.elastic;
    Eigen::VectorXd gradient = unfolding.elastic * (map - wanted);
    add_barrier(unfolding, map, gradient, curvature);
    unfolding.factors->factorize(curvature);
    const Eigen::VectorXd step = unfolding.factors->solve(gradient);
    if (unfolding.factors->info() != Eigen::Success || !step.allFinite())
      throw NumericsError("the map of the fluid's domain does not settle",
                          "its matrix has no factors at iteration " + std::to_string(result.iterations),
                          "a smaller time step");
    const double descent = gradient.dot(step);
    double part = 1, next = now;
    Eigen::VectorXd next_ratios;
    for (; part > 1e-6; part *= 0.5) {
      next_ratios = volume_ratios<dim>(unfolding, map - part * step);
      if (((next_ratios - least_part * ratios.cwiseMin(settings.threshold)).array() <= 0).any()) continue;
      next = energy(map - part * step, next_ratios);
      if (next <= now - 1e-4 * part * descent) break;
    }
    if (part <= 1e-6) break; // as low as rounding lets it come
    map -= part * step;
    now = next;
    const double change =
        ((next_ratios - ratios).array().abs() / next_ratios.cwiseMin(ratios).array().max(1e-300)).maxCoeff();
    ratios = next_ratios;
    if (part * step.template lpNorm<Eigen::Infinity>() <= settings.tolerance * scale && change <= settled)
      break;
  }
  result.smallest_ratio = ratios.minCoeff();
  result.displacement = by_node<dim>(map);
  return result;
}

template struct Unfolding<2>;
template Unfolding<2> prepare_unfolding(const Discretisation<2>&, const UnfoldingSettings&);
template UnfoldedMap<2> unfold(const Unfolding<2>&, const std::vector<Point<2>>&,
                               const std::function<std::vector<Eigen::VectorXd>()>&);

template struct Unfolding<3>;
template Unfolding<3> prepare_unfolding(const Discretisation<3>&, const UnfoldingSettings&);
template UnfoldedMap<3> unfold(const Unfolding<3>&, const std::vector<Point<3>>&,
                               const std::function<std::vector<Eigen::VectorXd>()>&);

} // namespace undula::fom
