#include "fom/contact/skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace undula::fom {

namespace {

/// Signed angle from a to b, counter-clockwise.
double angle_between(const Point<2>& a, const Point<2>& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

/// Bends the edges of a round skin: where edges meet at less than `sharp` the skin is taken for smooth, and
/// the middle of an edge is put on the circle through its ends and a neighbour, the mean of those of both
/// sides. The corners of a polygon would press into what they touch.
void bend(std::vector<SkinEdge<2>>& skin) {
  constexpr double sharp = 0.5; // rad; a circle has 16 corners at least
  std::map<int, const SkinEdge<2>*> begins, ends;
  for (const auto& edge : skin) {
    begins[edge.unknowns[0]] = &edge;
    ends[edge.unknowns[1]] = &edge;
  }
  std::vector<Point<2>> middles;
  for (const auto& edge : skin) {
    const Point<2>&a = edge.at_rest[0], &b = edge.at_rest[1];
    const auto before = ends.find(edge.unknowns[0]), after = begins.find(edge.unknowns[1]);
    double sum = 0;
    int smooth = 0;
    const auto add = [&](const Point<2>& other, bool meets_smoothly) {
      if (!meets_smoothly) return;
      sum += angle_between(a - other, b - other); // between the chord and the tangent at its end
      ++smooth;
    };
    if (before != ends.end()) {
      const Point<2>& other = before->second->at_rest[0];
      add(other, std::abs(angle_between(a - other, b - a)) < sharp);
    }
    if (after != begins.end()) {
      const Point<2>& other = after->second->at_rest[1];
      add(other, std::abs(angle_between(b - a, other - b)) < sharp);
    }
    Point<2> middle = edge.at_rest[2];
    if (smooth > 0) middle += 0.5 * std::tan(0.5 * sum / smooth) * outward(b - a);
    middles.push_back(middle);
  }
  for (std::size_t e = 0; e < skin.size(); ++e) skin[e].at_rest[2] = middles[e];
}

} // namespace

template <int dim>
std::vector<std::vector<SkinEdge<dim>>> skins_of(const Discretisation<dim>& disc) {
  static_assert(dim == 2);
  std::vector<std::vector<SkinEdge<dim>>> skins(disc.problem.solids.size());
  const bool axisymmetric = disc.problem.space == Space::axisymmetric;
  for (std::size_t s = 0; s < skins.size(); ++s) {
    for (const auto& facet : build_facet_table(disc.problem.solids[s].mesh).facets) {
      if (facet.cells[1] >= 0) continue;
      // Opposite vertex k: the edge from k + 1 to k + 2 has the cell on its left.
      const int first = (facet.local[0] + 1) % 3, last = (facet.local[0] + 2) % 3;
      const int middle = dim + first + last; // edges (0,1), (0,2), (1,2) follow the vertices
      const auto& nodes = disc.solid_spaces[s].cell_nodes[facet.cells[0]];
      SkinEdge<dim> edge;
      int next = 0;
      for (const int local : {first, last, middle}) {
        edge.unknowns[next] = disc.solid_unknown(static_cast<int>(s), nodes[local], 0);
        edge.at_rest[next++] = disc.solid_spaces[s].nodes[nodes[local]];
      }
      if (axisymmetric && edge.at_rest[0][0] == 0 && edge.at_rest[1][0] == 0) continue;
      skins[s].push_back(edge);
    }
    bend(skins[s]);
  }
  return skins;
}

template <int dim>
EdgeNodes<dim> displaced(const SkinEdge<dim>& edge, const Eigen::VectorXd& d) {
  EdgeNodes<dim> nodes;
  for (int i = 0; i < 3; ++i) nodes[i] = edge.at_rest[i] + d.template segment<dim>(edge.unknowns[i]);
  return nodes;
}

EdgeShape edge_shape(double s) { return {(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)}; }

EdgeShape edge_slope(double s) { return {4 * s - 3, 4 * s - 1, 4 - 8 * s}; }

template <int dim>
NearestOnEdge nearest_on_edge(const EdgeNodes<dim>& nodes, const Point<dim>& x) {
  constexpr int most = 20;
  constexpr double accuracy = 1e-8, beyond = 1e-9; // of the edge; the last step squares the first
  const Point<dim> chord = nodes[1] - nodes[0], bend = 4 * (nodes[0] + nodes[1] - 2 * nodes[2]);
  double s = (x - nodes[0]).dot(chord) / chord.squaredNorm();
  bool found = false;
  for (int k = 0; k < most && !found; ++k) {
    const Point<dim> away = x - on_edge<dim>(nodes, edge_shape(s)),
                     along = on_edge<dim>(nodes, edge_slope(s));
    const double slope = along.squaredNorm() - away.dot(bend);
    if (!(slope > 0)) break;
    const double change = away.dot(along) / slope;
    s = std::clamp(s + change, -1.0, 2.0);
    found = std::abs(change) <= accuracy;
  }
  if (found && s >= -beyond && s <= 1 + beyond) return {s, true};
  if (!found) s = (x - nodes[0]).squaredNorm() < (x - nodes[1]).squaredNorm() ? 0 : 1;
  return {std::clamp(s, 0.0, 1.0), false};
}

template std::vector<std::vector<SkinEdge<2>>> skins_of(const Discretisation<2>&);
template EdgeNodes<2> displaced(const SkinEdge<2>&, const Eigen::VectorXd&);
template NearestOnEdge nearest_on_edge(const EdgeNodes<2>&, const Point<2>&);

} // namespace undula::fom
