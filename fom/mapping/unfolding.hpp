// A map of the domain that may not fold: the linear extension, corrected where it squeezes elements.
//
// The correction y minimises, on the nodes of the cut,
//   (eps(y), eps(y)) + weight * sum over parts of |cell| b(J),   b(J) = log^2(J / threshold) / 2 below the
//   threshold, else 0,
// with y = 0 on the skin (Nitsche) and where the boundary holds the map. J is the volume ratio of the
// corrected map. b is a barrier: a part that does not fold before does not fold after. Where no J is below
// the threshold, y is 0, and y grows from there without a jump: the rate of the map stays as smooth in time
// as the motion of the skin. Elements share what a closing gap leaves them.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "fom/space/discretisation.hpp"

namespace undula::fom {

struct UnfoldingSettings {
  double threshold = 0.35;   ///< J below which an element resists
  double weight = 0.1;       ///< of the barrier against the elastic energy
  double skin_penalty = 200; ///< holds the correction off the skin
  double tolerance = 1e-4;   ///< of the last change, relative to the largest displacement
  int max_iterations = 400;
};

template <int dim>
struct Unfolding {
  using Matrix = Eigen::SparseMatrix<double>;
  using Factors = Eigen::SimplicialLDLT<Matrix>;
  UnfoldingSettings settings;
  Matrix elastic;                   ///< fluid nodes * dim, identity in held rows
  std::vector<char> held;           ///< by unknown
  std::unique_ptr<Factors> factors; ///< pattern analysed
  struct Element {
    std::array<int, dim + 1> nodes;                ///< fluid nodes
    Eigen::Matrix<double, dim, dim + 1> gradients; ///< at rest, 1/cm
    double measure = 0;                            ///< of the cell, cm^dim
  };
  std::vector<Element> elements; ///< one per part
};

/// Prepared once per cut, of a domain at rest (no map).
template <int dim>
Unfolding<dim> prepare_unfolding(const Discretisation<dim>& disc, const UnfoldingSettings& settings = {});

template <int dim>
struct UnfoldedMap {
  std::vector<Point<dim>> displacement; ///< by fluid node, cm
  int iterations = 0;                   ///< 0: the target does as it is
  double smallest_ratio = 1;            ///< of J, without the hoop's stretch
};

/// The map nearest to `target` that does not fold. `starts`, asked for where an element resists, gives
/// displacements to begin from, of which the one that is farthest from a fold is taken. Throws NumericsError
/// where all are folded, and where Newton's method does not settle.
template <int dim>
UnfoldedMap<dim> unfold(const Unfolding<dim>& unfolding, const std::vector<Point<dim>>& target,
                        const std::function<std::vector<Eigen::VectorXd>()>& starts);

} // namespace undula::fom
