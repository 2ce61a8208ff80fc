#include "rom/fixed_domain/continuation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace undula::rom {

std::vector<std::size_t> HeadContinuation::order(std::span<const double> heads) {
  std::vector<std::size_t> order, left(heads.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  while (!left.empty()) {
    // Next: the head farthest from all solved ones; the first is the lowest.
    const auto distance = [&](std::size_t i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto j : order) nearest = std::min(nearest, std::abs(heads[i] - heads[j]));
      return order.empty() ? -heads[i] : nearest;
    };
    const auto next = std::max_element(
        left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

void HeadContinuation::add(double head, const Eigen::MatrixXd& velocity) {
  const bool known =
      std::any_of(solved_.begin(), solved_.end(), [&](const Solved& s) { return s.head == head; });
  if (!known) solved_.push_back({head, velocity});
}

Eigen::MatrixXd HeadContinuation::guess(double head) const {
  if (solved_.empty()) return {};
  std::vector<const Solved*> nodes;
  for (const auto& solved : solved_) nodes.push_back(&solved);
  std::sort(nodes.begin(), nodes.end(), [&](const Solved* a, const Solved* b) {
    return std::abs(a->head - head) < std::abs(b->head - head);
  });
  // Higher degrees gain nothing and amplify the tolerance of the states.
  constexpr std::size_t most_nodes = 6;
  nodes.resize(std::min(nodes.size(), most_nodes));
  Eigen::Index columns = 0;
  for (const auto* node : nodes) columns = std::max(columns, node->velocity.cols());
  Eigen::MatrixXd guess = Eigen::MatrixXd::Zero(nodes.front()->velocity.rows(), columns);
  for (const auto* node : nodes) {
    double weight = 1; // Lagrange's basis
    for (const auto* other : nodes)
      if (other != node) weight *= (head - other->head) / (node->head - other->head);
    guess.leftCols(node->velocity.cols()) += weight * node->velocity;
  }
  return guess;
}

} // namespace undula::rom
