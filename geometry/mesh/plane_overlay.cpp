#include "geometry/mesh/plane_overlay.hpp"

#include <algorithm>
#include <cmath>

namespace undula::geometry {
namespace {

constexpr double nothing = 1e-10; ///< of the largest extent

struct Edge {
  Point<2> low, high; ///< by their heights
  int region = 0, segment = 0;

  double at(double y) const {
    const double s = std::clamp((y - low.y()) / (high.y() - low.y()), 0.0, 1.0);
    return low.x() + s * (high.x() - low.x());
  }
};

/// Part of a row between two neighbouring clusters of edges.
struct Piece {
  OverlayPiece shape;
  std::vector<char> inside;
  std::vector<int> left, right; ///< edges
};

/// Union of what hangs together.
class Groups {
public:
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) { parent_[root(i)] = root(j); }

private:
  std::vector<int> parent_;
};

double overlap(double a_low, double a_high, double b_low, double b_high) {
  return std::min(a_high, b_high) - std::max(a_low, b_low);
}

class Sweep {
public:
  explicit Sweep(const std::vector<PlaneRegion>& regions) : regions_(static_cast<int>(regions.size())) {
    std::vector<Segment<2>> all;
    Point<2> low = Point<2>::Constant(HUGE_VAL), high = -low;
    for (const auto& region : regions)
      for (const auto& segment : region) {
        all.push_back(segment);
        low = low.cwiseMin(segment.a).cwiseMin(segment.b);
        high = high.cwiseMax(segment.a).cwiseMax(segment.b);
      }
    small_ = all.empty() ? 0 : nothing * (high - low).maxCoeff();
    for (int region = 0; region < regions_; ++region)
      for (std::size_t i = 0; i < regions[region].size(); ++i) {
        const auto& [a, b] = regions[region][i];
        const Edge edge = {a.y() <= b.y() ? a : b, a.y() <= b.y() ? b : a, region, static_cast<int>(i)};
        (edge.high.y() - edge.low.y() <= small_ ? level_ : edges_).push_back(edge);
      }
    collect_heights(all);
    std::sort(edges_.begin(), edges_.end(),
              [](const Edge& a, const Edge& b) { return a.low.y() < b.low.y(); });
  }

  PlaneOverlay run() {
    for (std::size_t row = 0; row + 1 < heights_.size(); ++row) add_row(row);
    add_level_borders();
    return collect();
  }

private:
  void collect_heights(const std::vector<Segment<2>>& all) {
    std::vector<double> heights;
    for (const auto& segment : all) {
      heights.push_back(segment.a.y());
      heights.push_back(segment.b.y());
    }
    visit_near_pairs(all, 0, [&](std::size_t i, std::size_t j) {
      const Point<2> u = all[i].b - all[i].a, v = all[j].b - all[j].a, w = all[j].a - all[i].a;
      const double det = u.x() * v.y() - u.y() * v.x();
      if (det == 0) return true;
      const double s = (w.x() * v.y() - w.y() * v.x()) / det, t = (w.x() * u.y() - w.y() * u.x()) / det;
      if (s > 0 && s < 1 && t > 0 && t < 1) heights.push_back(all[i].a.y() + s * u.y());
      return true;
    });
    std::sort(heights.begin(), heights.end());
    for (const double y : heights)
      if (heights_.empty() || y > heights_.back() + small_) heights_.push_back(y);
  }

  void add_row(std::size_t row) {
    const double low = heights_[row], high = heights_[row + 1], middle = 0.5 * (low + high);
    while (next_ < edges_.size() && edges_[next_].low.y() <= low + small_)
      active_.push_back(static_cast<int>(next_++));
    std::erase_if(active_, [&](int e) { return edges_[e].high.y() < high - small_; });
    std::vector<std::pair<double, int>> order;
    for (const int e : active_) order.emplace_back(edges_[e].at(middle), e);
    std::sort(order.begin(), order.end());

    rows_.emplace_back();
    std::vector<char> inside(regions_, 0);
    std::vector<int> cluster;
    int open = -1; // piece that waits for its right edges
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int e = order[k].second;
      cluster.push_back(e);
      inside[edges_[e].region] ^= 1;
      const bool last = k + 1 == order.size();
      if (!last && order[k + 1].first - order[k].first <= small_) continue;
      if (open >= 0) pieces_[open].right = cluster;
      const int before = open;
      open = -1;
      if (!last && std::find(inside.begin(), inside.end(), 1) != inside.end()) {
        const Edge &l = edges_[e], &r = edges_[order[k + 1].second];
        Piece piece;
        piece.shape.corners = {Point<2>(l.at(low), low), Point<2>(r.at(low), low), Point<2>(r.at(high), high),
                               Point<2>(l.at(high), high)};
        piece.inside = inside;
        piece.left = cluster;
        open = groups_.add();
        pieces_.push_back(std::move(piece));
        rows_.back().push_back(open);
        if (before >= 0 && pieces_[before].inside == inside) groups_.join(before, open);
      }
      cluster.clear();
    }
    if (row == 0) return;
    for (const int below : rows_[row - 1])
      for (const int above : rows_[row]) {
        const auto &a = pieces_[below].shape.corners, &b = pieces_[above].shape.corners;
        if (b[0].x() > a[2].x()) break; // from left to right
        if (pieces_[below].inside == pieces_[above].inside &&
            overlap(a[3].x(), a[2].x(), b[0].x(), b[1].x()) > small_)
          groups_.join(below, above);
      }
  }

  /// Edges along a height bound what lies above and below.
  void add_level_borders() {
    for (const Edge& edge : level_) {
      const double y = edge.low.y();
      const auto above = std::upper_bound(heights_.begin(), heights_.end(), y + small_);
      if (above == heights_.begin()) continue;
      const auto row = static_cast<std::size_t>(above - heights_.begin()) - 1;
      const double from = std::min(edge.low.x(), edge.high.x()), to = std::max(edge.low.x(), edge.high.x());
      const auto touch = [&](std::size_t at, int left, int right) {
        if (at >= rows_.size()) return;
        for (const int piece : rows_[at]) {
          const auto& x = pieces_[piece].shape.corners;
          const double length = overlap(from, to, x[left].x(), x[right].x());
          if (length > small_) borders_.push_back({piece, {edge.region, edge.segment}, length});
        }
      };
      touch(row, 0, 1);
      if (row > 0) touch(row - 1, 3, 2);
    }
  }

  PlaneOverlay collect() {
    PlaneOverlay overlay;
    std::map<int, int> part_of_root;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto [entry, added] =
          part_of_root.try_emplace(groups_.root(static_cast<int>(i)), static_cast<int>(overlay.parts.size()));
      if (added) overlay.parts.push_back({pieces_[i].inside, 0, {}});
      Piece& piece = pieces_[i];
      piece.shape.part = entry->second;
      auto& part = overlay.parts[entry->second];
      const auto& x = piece.shape.corners;
      const double height = x[2].y() - x[1].y();
      part.area += 0.5 * height * (x[1].x() - x[0].x() + x[2].x() - x[3].x());
      for (const auto* side : {&piece.left, &piece.right})
        for (const int e : *side) {
          const Edge& edge = edges_[e];
          const double slope = (edge.high.x() - edge.low.x()) / (edge.high.y() - edge.low.y());
          part.borders[{edge.region, edge.segment}] += height * std::hypot(1.0, slope);
        }
      overlay.pieces.push_back(piece.shape);
    }
    for (const auto& [piece, edge, length] : borders_)
      overlay.parts[pieces_[piece].shape.part].borders[edge] += length;
    return overlay;
  }

  struct Border {
    int piece;
    std::pair<int, int> edge;
    double length;
  };

  int regions_;
  double small_ = 0;                ///< cm
  std::vector<Edge> edges_, level_; ///< that rise, sorted; that do not
  std::vector<double> heights_;
  std::vector<int> active_;
  std::size_t next_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::vector<int>> rows_;
  std::vector<Border> borders_;
  Groups groups_;
};

} // namespace

bool OverlayPart::only_in(int one) const {
  for (std::size_t region = 0; region < inside.size(); ++region)
    if ((inside[region] != 0) != (static_cast<int>(region) == one)) return false;
  return true;
}

PlaneOverlay lay_over(const std::vector<PlaneRegion>& regions) { return Sweep(regions).run(); }

} // namespace undula::geometry
