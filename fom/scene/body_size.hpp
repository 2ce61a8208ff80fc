// Element size of a body's own mesh: small in its boxes, growing away from them.
#pragma once

#include <vector>

#include "fom/fom.hpp"
#include "fom/scene/problem_statement.hpp"
#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/refinement_box.hpp"

namespace undula::fom {

class BodySize {
public:
  BodySize(const ProblemStatement& problem, const std::string& body);

  double operator()(const Point<2>& x) const { return at(x).size; }
  /// With its source: 0 the body's own size, else the box before in `keys`.
  SizeOfSource at(const Point<2>& x) const;

  double growth() const { return growth_; }
  /// The keys that state the sizes, by source.
  const std::vector<std::string>& keys() const { return keys_; }

  /// The corners of a circle of `body` with more between them on the arc, as near as the size asks for;
  /// corners of another shape as they are.
  std::vector<Point<2>> divided(const BodyStatement& body, const std::vector<Point<2>>& corners) const;

private:
  double largest_, growth_;
  std::vector<std::string> keys_;
  std::vector<RefinementBox<2>> boxes_;
};

} // namespace undula::fom
