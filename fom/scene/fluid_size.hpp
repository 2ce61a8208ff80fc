// Element size of the fluid in a stated domain: small at some edges and in some boxes, growing away from
// them.
#pragma once

#include <string>
#include <vector>

#include "fom/scene/problem_statement.hpp"
#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/refinement_box.hpp"
#include "geometry/mesh/sized_segments.hpp"

namespace undula::fom {

/// The fluid's domain as a polygon with holes, corners of circles as far apart as the sizes there.
geometry::TaggedPolygon domain_polygon(const ProblemStatement& problem);

class FluidSize {
public:
  FluidSize(const ProblemStatement& problem, const geometry::TaggedPolygon& domain, bool axisymmetric);

  double operator()(const geometry::Point<2>& x) const { return at(x).size; }

  /// The size and the key that asks for it, an index into `keys`.
  geometry::SizeOfSource at(const geometry::Point<2>& x) const;

  const std::vector<std::string>& keys() const { return keys_; }

private:
  double largest_, growth_;
  std::vector<std::string> keys_;
  geometry::SizedSegments edges_;
  std::vector<std::pair<geometry::RefinementBox<2>, int>> boxes_;
};

} // namespace undula::fom
