// Boxes along the axes, and the broad phase of the cut: which of a set touch a given one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Closed axis-aligned box, cm.
template <int dim>
struct Box {
  Point<dim> low, high;
  bool touches(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Box around points; of none, one that is inside out.
template <int dim>
Box<dim> box_around(const std::vector<Point<dim>>& points) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box<dim> box{Point<dim>::Constant(infinity), Point<dim>::Constant(-infinity)};
  for (const auto& x : points) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  return box;
}

/// Box of a cell, exact.
template <int dim>
Box<dim> cell_box(const SimplexMesh<dim>& mesh, int cell) {
  const auto& points = mesh.cells[cell];
  Box<dim> box{mesh.points[points[0]], mesh.points[points[0]]};
  for (const int p : points) {
    box.low = box.low.cwiseMin(mesh.points[p]);
    box.high = box.high.cwiseMax(mesh.points[p]);
  }
  return box;
}

/// Boxes sorted into the bins of a uniform grid.
template <int dim>
class BoxGrid {
public:
  explicit BoxGrid(std::vector<Box<dim>> boxes) : boxes_(std::move(boxes)) {
    if (boxes_.empty()) return;
    extent_ = boxes_.front();
    Point<dim> mean_size = Point<dim>::Zero();
    for (const auto& box : boxes_) {
      extent_.low = extent_.low.cwiseMin(box.low);
      extent_.high = extent_.high.cwiseMax(box.high);
      mean_size += (box.high - box.low) / static_cast<double>(boxes_.size());
    }
    // No more bins than a few per box, however small the boxes are in their extent.
    const int most = 1 + static_cast<int>(std::pow(4.0 * static_cast<double>(boxes_.size()), 1.0 / dim));
    int total = 1;
    for (int i = 0; i < dim; ++i) {
      const double wanted = (extent_.high[i] - extent_.low[i]) / std::max(mean_size[i], 1e-300);
      bins_[i] = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most)));
      total *= bins_[i];
    }
    members_.resize(total);
    for (int b = 0; b < static_cast<int>(boxes_.size()); ++b)
      for_each_bin(boxes_[b], [&](int bin) { members_[bin].push_back(b); });
  }

  /// Indices of the boxes that touch `box`, ascending.
  std::vector<int> touching(const Box<dim>& box) const {
    std::vector<int> found;
    if (boxes_.empty() || !box.touches(extent_)) return found;
    for_each_bin(box, [&](int bin) {
      for (const int b : members_[bin])
        if (boxes_[b].touches(box)) found.push_back(b);
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

private:
  int bin_of(double x, int axis) const {
    const double width = extent_.high[axis] - extent_.low[axis];
    const double at = width > 0 ? (x - extent_.low[axis]) / width * bins_[axis] : 0;
    return static_cast<int>(std::clamp(at, 0.0, bins_[axis] - 1.0)); // monotone in x, so no touch is missed
  }

  template <class Visit>
  void for_each_bin(const Box<dim>& box, const Visit& visit) const {
    std::array<int, dim> first, last, index;
    for (int i = 0; i < dim; ++i) {
      index[i] = first[i] = bin_of(box.low[i], i);
      last[i] = bin_of(box.high[i], i);
    }
    for (bool more = true; more;) {
      int flat = 0;
      for (int i = dim - 1; i >= 0; --i) flat = flat * bins_[i] + index[i];
      visit(flat);
      more = false;
      for (int i = 0; i < dim && !more; ++i) {
        more = ++index[i] <= last[i];
        if (!more) index[i] = first[i];
      }
    }
  }

  std::vector<Box<dim>> boxes_;
  Box<dim> extent_;
  std::array<int, dim> bins_{};
  std::vector<std::vector<int>> members_;
};

} // namespace undula::geometry
