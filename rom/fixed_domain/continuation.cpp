#include "rom/fixed_domain/continuation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace undula::rom {

std::vector<std::size_t> HeadContinuation::order(std::span<const double> heads) {
  // Next: the head farthest from all solved ones; the first is the lowest.
  std::vector<double> distance(heads.size());
  std::transform(heads.begin(), heads.end(), distance.begin(), std::negate<>());
  std::vector<bool> solved(heads.size(), false);
  std::vector<std::size_t> order;
  while (order.size() < heads.size()) {
    std::size_t next = heads.size();
    for (std::size_t i = 0; i < heads.size(); ++i)
      if (!solved[i] && (next == heads.size() || distance[i] > distance[next])) next = i;
    for (std::size_t i = 0; i < heads.size(); ++i) {
      const double to_next = std::abs(heads[i] - heads[next]);
      distance[i] = order.empty() ? to_next : std::min(distance[i], to_next);
    }
    solved[next] = true;
    order.push_back(next);
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
