#include "geometry/mesh/mesh_estimate.hpp"

#include <array>
#include <cmath>

namespace undula::geometry {
namespace {

constexpr double even_enough = 0.5;   ///< change of the size within a piece, as a part of it
constexpr int most_divisions = 60;    ///< of one piece
constexpr int most_asked = 1'000'000; ///< sizes

using Corners = std::array<Point<2>, 4>;

double area(const Corners& x) {
  const Point<2> u = x[2] - x[0], v = x[3] - x[1];
  return 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
}

class Estimator {
public:
  Estimator(const std::function<SizeOfSource(const Point<2>&)>& size, double growth, int sources, double most)
      : size_(size), growth_(growth), most_(most) {
    result_.by_source.assign(sources, 0.0);
  }

  void add(const Corners& x, int divisions) {
    if (result_.cells > most_ || asked_ > most_asked) return;
    const double extent = std::max((x[2] - x[0]).norm(), (x[3] - x[1]).norm());
    const SizeOfSource here = size_(0.25 * (x[0] + x[1] + x[2] + x[3]));
    ++asked_;
    if (growth_ * extent > even_enough * here.size && extent > here.size && divisions < most_divisions) {
      const bool wide =
          (x[1] - x[0]).norm() + (x[2] - x[3]).norm() > (x[3] - x[0]).norm() + (x[2] - x[1]).norm();
      const Point<2> m = wide ? Point<2>(0.5 * (x[0] + x[1])) : Point<2>(0.5 * (x[1] + x[2]));
      const Point<2> n = wide ? Point<2>(0.5 * (x[2] + x[3])) : Point<2>(0.5 * (x[3] + x[0]));
      add(wide ? Corners{x[0], m, n, x[3]} : Corners{x[0], x[1], m, n}, divisions + 1);
      add(wide ? Corners{m, x[1], x[2], n} : Corners{n, m, x[2], x[3]}, divisions + 1);
      return;
    }
    const double cells = area(x) / (mean_cell_area * here.size * here.size);
    result_.cells += cells;
    result_.by_source[here.source] += cells;
  }

  const CellEstimate& result() const { return result_; }

private:
  const std::function<SizeOfSource(const Point<2>&)>& size_;
  double growth_, most_;
  long asked_ = 0;
  CellEstimate result_;
};

} // namespace

CellEstimate estimate_cells(std::span<const OverlayPiece> pieces,
                            const std::function<SizeOfSource(const Point<2>&)>& size, double growth,
                            int sources, double most) {
  Estimator estimator(size, growth, sources, most);
  for (const auto& piece : pieces) estimator.add(piece.corners, 0);
  return estimator.result();
}

} // namespace undula::geometry
