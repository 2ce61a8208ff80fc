// A plane or axisymmetric problem by the outlines of its fluid and its solids at rest, and what about them
// makes no sense whatever the mesh.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/plane_overlay.hpp"

namespace undula::fom {

/// A named part of the fluid's boundary.
struct OutlinedSide {
  enum class Kind { closed, velocity, opening };
  std::string name;
  Kind kind = Kind::closed;
  std::string where; ///< for messages
};

struct OutlinedBody {
  std::string name;
  std::vector<Segment<2>> outline; ///< with its holes
  bool still = false;              ///< held as a whole and not moved
  std::string where;               ///< for messages
  bool may_be_dry = false;         ///< it has a load or may touch something: it need not be in the fluid
};

struct OutlinedProblem {
  std::vector<Segment<2>> fluid; ///< domain and holes, without the bodies; empty: solids in vacuo
  std::vector<int> side;         ///< of each segment of `fluid`, an index into `sides`
  std::vector<OutlinedSide> sides;
  std::vector<OutlinedBody> bodies;
  std::string where; ///< of the domain, for messages
};

/// What flows in through segments of the fluid's boundary at a time that shows it, as a part of what flows in
/// and out; 0 where nothing does.
using NetInflow = std::function<double(const std::vector<int>& segments)>;

/// Refuses (InputError) bodies that lie wholly outside of the fluid without a reason, or over one another in
/// it (in vacuo: anywhere), no fluid left between them, openings and inflows that they cover, and parts of
/// the fluid that are closed all around by walls and still bodies although fluid flows into them, or beside
/// others, where nothing says their pressure. Returns the overlay of the fluid (region 0) and the bodies.
PlaneOverlay check_outlines(const OutlinedProblem& problem, const NetInflow& net_inflow);

} // namespace undula::fom
