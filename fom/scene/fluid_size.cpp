#include "fom/scene/fluid_size.hpp"

#include <algorithm>

#include "fom/scene/shape_outline.hpp"
#include "geometry/mesh/polygons.hpp"

namespace undula::fom {
namespace {

double size_at(const ProblemStatement& problem, const std::string& boundary) {
  const auto found = problem.boundaries.find(boundary);
  const double size = found == problem.boundaries.end() ? 0.0 : found->second.size;
  return size > 0 ? std::min(size, problem.domain.size) : problem.domain.size;
}

int tag_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

/// Counter-clockwise, with the tags of its edges.
void orient(TaggedPolygon& polygon) {
  if (polygon_area(polygon.points) > 0) return;
  std::reverse(polygon.points.begin(), polygon.points.end());
  // Edge j now runs from the old corner n-1-j to n-2-j.
  std::reverse(polygon.tags.begin(), polygon.tags.end());
  std::rotate(polygon.tags.begin(), polygon.tags.begin() + 1, polygon.tags.end());
}

/// The distance that sizes of a general problem have always been measured by, to the last digit.
double to_edge(const Segment<2>& edge, const Point<2>& x) {
  return distance_to_segment<2>(edge.a, edge.b, x);
}

/// Edges that ask for a size; adds the keys that state them to `keys`.
std::vector<SizedSegment> sized_edges(const ProblemStatement& problem, const TaggedPolygon& domain,
                                      bool axisymmetric, std::vector<std::string>& keys) {
  std::vector<SizedSegment> edges;
  const auto add = [&](const Point<2>& a, const Point<2>& b, double size, const std::string& key) {
    if (size > 0) edges.push_back({{a, b}, size, tag_of(keys, key)});
  };
  const auto add_loop = [&](const std::vector<Point<2>>& loop, double size, const std::string& key) {
    for (std::size_t i = 0; i < loop.size(); ++i) add(loop[i], loop[(i + 1) % loop.size()], size, key);
  };
  const auto key_at = [&](const std::string& boundary) {
    const double size = size_at(problem, boundary);
    return size < problem.domain.size ? "boundary." + boundary + ".size_mm" : std::string("domain.size_mm");
  };
  const std::size_t n = domain.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& side = domain.names[domain.tags[i]];
    add(domain.points[i], domain.points[(i + 1) % n], size_at(problem, side), key_at(side));
  }
  for (const auto& hole : domain.holes) {
    const std::string& name = domain.names[hole.tag];
    add_loop(hole.points, size_at(problem, name), key_at(name));
  }
  for (const auto& [name, body] : problem.bodies) {
    const double wanted = body.fluid_size > 0 ? body.fluid_size : problem.domain.size;
    const std::string key = "body." + name + ".fluid_size_mm";
    add_loop(corners_of(body.shape, wanted, axisymmetric), body.fluid_size, key);
    if (body.shape.inner_radius > 0)
      add_loop(circle(body.shape.centre, body.shape.inner_radius, wanted), body.fluid_size, key);
  }
  return edges;
}

} // namespace

TaggedPolygon domain_polygon(const ProblemStatement& problem) {
  const auto& domain = problem.domain;
  TaggedPolygon polygon;
  polygon.points = corners_of(domain.shape, size_at(problem, domain.sides.front()));
  for (std::size_t i = 0; i < polygon.points.size(); ++i)
    polygon.tags.push_back(tag_of(polygon.names, domain.sides[domain.shape.radius > 0 ? 0 : i]));
  orient(polygon);
  for (const auto& [name, hole] : problem.holes)
    polygon.holes.push_back({corners_of(hole.shape, size_at(problem, name)), tag_of(polygon.names, name)});
  return polygon;
}

FluidSize::FluidSize(const ProblemStatement& problem, const TaggedPolygon& domain, bool axisymmetric)
    : largest_(problem.domain.size),
      growth_(problem.domain.growth),
      keys_{"domain.size_mm"},
      edges_(sized_edges(problem, domain, axisymmetric, keys_), growth_, to_edge) {
  for (const auto& [name, box] : problem.refinements) {
    if (!box.body.empty()) continue;
    boxes_.push_back(
        {{point_of(box.box[0]), point_of(box.box[1]), box.size}, static_cast<int>(keys_.size())});
    keys_.push_back("refine." + name + ".size_mm");
  }
}

SizeOfSource FluidSize::at(const Point<2>& x) const {
  SizeOfSource smallest = {largest_, 0};
  edges_.lower(x, smallest.size, smallest.source);
  for (const auto& [box, source] : boxes_)
    if (const double size = size_about(box, growth_, x); size < smallest.size) smallest = {size, source};
  return smallest;
}

} // namespace undula::fom
