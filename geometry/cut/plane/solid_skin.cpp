#include "geometry/cut/plane/solid_skin.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include "geometry/cut/space/orientation.hpp"
#include "geometry/mesh/box_grid.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

constexpr const char* remedy = "a smaller time step or stroke, a contact model, or solids placed apart";

std::string cell_name(int solid, int cell) {
  return "cell " + std::to_string(cell) + " of the solid mesh " + std::to_string(solid);
}

std::string position(const Point<2>& x) {
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ") cm";
  return text.str();
}

Box<2> box_of(const PlacedSegment& segment) {
  return {segment.a.cwiseMin(segment.b), segment.a.cwiseMax(segment.b)};
}

// Appends the segments of one solid, line by line.
void append_lines(std::vector<SkinSegment> loose, int points, SolidSkin& skin) {
  std::vector<std::vector<int>> leaving(points);
  for (int s = 0; s < static_cast<int>(loose.size()); ++s) leaving[loose[s].from].push_back(s);
  for (auto& segment : loose)
    segment.pinched = leaving[segment.from].size() > 1 || leaving[segment.to].size() > 1;
  std::vector<char> taken(loose.size(), 0);
  for (int start = 0; start < static_cast<int>(loose.size()); ++start) {
    if (taken[start]) continue;
    for (int s = start; s >= 0;) {
      taken[s] = 1;
      skin.segments.push_back(loose[s]);
      const auto& onward = leaving[loose[s].to];
      const auto next = std::find_if(onward.begin(), onward.end(), [&](int t) { return !taken[t]; });
      s = next == onward.end() ? -1 : *next;
    }
    skin.lines.push_back(static_cast<int>(skin.segments.size()));
  }
}

// Segments that meet end to end touch elsewhere only if the second folds back onto the first.
bool folds_back(const PlacedSegment& first, const PlacedSegment& second) {
  return (first.b - first.a).dot(second.b - second.a) < 0 &&
         exact_orientation(first.a, first.b, second.b) == 0;
}

enum class Meeting { apart, touching, crossing };

constexpr double contact_depth = 1e-12; // of the longer segment: bodies in contact overlap by rounding

// How far the ends of two segments that cross reach beyond each other, at least, over the longer segment.
double relative_depth(const PlacedSegment& s, const PlacedSegment& t) {
  const double s_length = (s.b - s.a).norm(), t_length = (t.b - t.a).norm();
  const auto depth = [](const PlacedSegment& line, double length, const Point<2>& x) {
    return std::abs(orientation(line.a, line.b, x).value) / length;
  };
  return std::min({depth(s, s_length, t.a), depth(s, s_length, t.b), depth(t, t_length, s.a),
                   depth(t, t_length, s.b)}) /
         std::max(s_length, t_length);
}

Meeting meeting(const PlacedSegment& s, const PlacedSegment& t) {
  const int ta = exact_orientation(s.a, s.b, t.a);
  const int tb = exact_orientation(s.a, s.b, t.b);
  if (ta * tb > 0) return Meeting::apart;
  const int sa = exact_orientation(t.a, t.b, s.a);
  const int sb = exact_orientation(t.a, t.b, s.b);
  if (sa * sb > 0) return Meeting::apart;
  if (ta * tb < 0 && sa * sb < 0 && relative_depth(s, t) > contact_depth) return Meeting::crossing;
  return Meeting::touching; // or collinear, with boxes that touch
}

} // namespace

SolidSkin build_solid_skin(std::span<const SimplexMesh<2>> solids, std::span<const FacetTable<2>> facets) {
  SolidSkin skin;
  skin.lines.push_back(0);
  for (int s = 0; s < static_cast<int>(solids.size()); ++s) {
    std::vector<SkinSegment> loose;
    for (const auto& facet : facets[s].facets) {
      const auto from = [&](int k) { return solids[s].cells[facet.cells[k]][(facet.local[k] + 1) % 3]; };
      const auto to = [&](int k) { return solids[s].cells[facet.cells[k]][(facet.local[k] + 2) % 3]; };
      if (facet.cells[1] < 0)
        loose.push_back({s, facet.cells[0], from(0), to(0)});
      else if (from(0) == from(1))
        throw NumericsError("a mesh to be cut is folded", cell_name(s, facet.cells[0]),
                            "a mesh whose cells are all positively oriented");
    }
    append_lines(std::move(loose), static_cast<int>(solids[s].points.size()), skin);
  }
  return skin;
}

std::vector<PlacedSegment> place_skin(const SolidSkin& skin, std::span<const SimplexMesh<2>> solids) {
  std::vector<PlacedSegment> placed;
  placed.reserve(skin.segments.size());
  for (const auto& segment : skin.segments) {
    const auto& points = solids[segment.solid].points;
    placed.push_back({points[segment.from], points[segment.to]});
  }
  return placed;
}

template <int dim>
void check_placed_solids(std::span<const SimplexMesh<dim>> solids) {
  for (int s = 0; s < static_cast<int>(solids.size()); ++s) {
    for (std::size_t p = 0; p < solids[s].points.size(); ++p)
      if (!solids[s].points[p].allFinite())
        throw NumericsError("a solid has been placed nowhere (its position is not a number)",
                            "point " + std::to_string(p) + " of the solid mesh " + std::to_string(s),
                            "a smaller time step");
    for (int c = 0; c < static_cast<int>(solids[s].cells.size()); ++c) {
      const auto& v = solids[s].cells[c];
      const auto& x = solids[s].points;
      bool positive;
      if constexpr (dim == 2)
        positive = exact_orientation(x[v[0]], x[v[1]], x[v[2]]) > 0;
      else
        positive = exact_orientation(x[v[0]], x[v[1]], x[v[2]], x[v[3]]) > 0;
      if (!positive)
        throw NumericsError("a cell of a placed solid is flat or inverted", cell_name(s, c),
                            "a smaller time step or stroke, or a finer solid mesh");
    }
  }
}

std::vector<int> touching_segments(const SolidSkin& skin, std::span<const PlacedSegment> placed) {
  std::vector<Box<2>> boxes;
  boxes.reserve(placed.size());
  for (const auto& segment : placed) boxes.push_back(box_of(segment));
  const BoxGrid<2> grid(std::move(boxes));
  std::vector<int> touching;
  for (int s = 0; s < static_cast<int>(placed.size()); ++s) {
    const auto& segment = skin.segments[s];
    for (const int t : grid.touching(box_of(placed[s]))) {
      if (t <= s) continue;
      const auto& other = skin.segments[t];
      const bool onward = segment.solid == other.solid && segment.to == other.from;
      const bool back = segment.solid == other.solid && segment.from == other.to;
      if (onward || back) {
        if ((onward && folds_back(placed[s], placed[t])) || (back && folds_back(placed[t], placed[s]))) {
          touching.push_back(s);
          touching.push_back(t);
        }
        continue;
      }
      const auto how = meeting(placed[s], placed[t]);
      if (how == Meeting::crossing)
        throw NumericsError("cutting the background mesh failed: the skins of solids cross",
                            cell_name(segment.solid, segment.cell) + " and " +
                                cell_name(other.solid, other.cell) + " near " + position(placed[s].a),
                            remedy);
      if (how == Meeting::touching) {
        touching.push_back(s);
        touching.push_back(t);
      }
    }
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  return touching;
}

template void check_placed_solids<2>(std::span<const SimplexMesh<2>>);
template void check_placed_solids<3>(std::span<const SimplexMesh<3>>);

} // namespace undula::geometry
