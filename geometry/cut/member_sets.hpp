// Disjoint sets of the members 0, 1, .. of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace undula::geometry {

/// The root of a set is its smallest member, so that a numbering by roots follows the order of the list.
class MemberSets {
public:
  explicit MemberSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<int> parent_;
};

} // namespace undula::geometry
