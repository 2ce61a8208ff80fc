#include "geometry/cut/plane/fluid_polygons.hpp"

#include <algorithm>

#include "geometry/mesh/polygons.hpp"

namespace undula::geometry {
namespace {

// A crossing seen from the cell. Edge e runs from vertex e to vertex e + 1, counter-clockwise.
struct Event {
  int crossing;
  int edge;
  int rank;   // among the crossings of the edge
  bool entry; // the skin comes in: solid before, fluid after
};

int opposite(int edge) { return (edge + 2) % 3; }

void append_chain(const SkinTrace& trace, int chain, std::vector<Point<2>>& corners) {
  corners.push_back(trace.pieces[trace.chains[chain].first].from);
  for (int piece = trace.chains[chain].first; piece >= 0; piece = trace.pieces[piece].next)
    corners.push_back(trace.pieces[piece].to);
}

} // namespace

bool find_fluid_polygons(const BackgroundIndex& background, const SkinTrace& trace, int cell,
                         FluidPolygons& polygons) {
  polygons.count = 0;
  polygons.stretches.clear();
  polygons.chains.clear();
  polygons.fluid_area = polygons.solid_area = 0;
  const auto& facets = background.facets();
  const auto& mesh = background.mesh();

  std::vector<Event> events; // counter-clockwise
  int count[3];
  bool forward[3];
  for (int edge = 0; edge < 3; ++edge) {
    const int facet = facets.cell_facets[cell][opposite(edge)];
    const int side = facets.facets[facet].cells[0] == cell ? 0 : 1;
    count[edge] = trace.count(facet);
    forward[edge] = background.forward(facet, side);
    for (int rank = 0; rank < count[edge]; ++rank) {
      const int i = forward[edge] ? rank : count[edge] - 1 - rank;
      const int crossing = trace.sorted[trace.facet_crossings[facet] + i];
      events.push_back({crossing, edge, rank, trace.crossings[crossing].into == side});
    }
  }
  const int n = static_cast<int>(events.size());
  if (n == 0 || n % 2 == 1) return false;
  for (int i = 0; i < n; ++i)
    if (events[i].entry == events[(i + 1) % n].entry) return false;

  const auto event_of = [&](int crossing) {
    return static_cast<int>(
        std::find_if(events.begin(), events.end(), [&](const Event& e) { return e.crossing == crossing; }) -
        events.begin());
  };
  const auto corner = [&](int vertex) -> const Point<2>& { return mesh.points[mesh.cells[cell][vertex]]; };
  const auto add_stretch = [&](int edge, int rank, int polygon) {
    polygons.stretches.push_back({opposite(edge), forward[edge] ? rank : count[edge] - rank, polygon});
  };
  const auto corners_between = [&](int from, int to) { // counter-clockwise, from one event to the next
    return events[to].edge - events[from].edge + (to <= from ? 3 : 0);
  };

  // Fluid lies at the right of the skin: along chains, then clockwise around the cell to the next entry.
  std::vector<char> done(n, 0);
  for (int start = 0; start < n; ++start) {
    if (!events[start].entry || done[start]) continue;
    const int polygon = polygons.count++;
    if (static_cast<int>(polygons.corners.size()) < polygons.count) polygons.corners.emplace_back();
    auto& outline = polygons.corners[polygon];
    outline.clear();
    for (int at = start; !done[at];) {
      done[at] = 1;
      const int chain = trace.crossings[events[at].crossing].chain;
      append_chain(trace, chain, outline);
      polygons.chains.push_back({chain, polygon});
      const int out = event_of(trace.chains[chain].exit);
      if (out == n || events[out].entry) return false;
      const int next = (out + n - 1) % n;
      add_stretch(events[out].edge, events[out].rank, polygon);
      for (int edge = events[out].edge, left = corners_between(next, out); left > 0; --left) {
        outline.push_back(corner(edge));
        edge = opposite(edge); // the edge before
        add_stretch(edge, count[edge], polygon);
      }
      at = next;
      if (done[at] && at != start) return false;
    }
    std::reverse(outline.begin(), outline.end());
    polygons.fluid_area += polygon_area(outline);
  }

  // The solid's outlines, on the other side of the same chains.
  std::fill(done.begin(), done.end(), 0);
  std::vector<Point<2>> outline;
  for (int start = 0; start < n; ++start) {
    if (!events[start].entry || done[start]) continue;
    outline.clear();
    for (int at = start; !done[at];) {
      done[at] = 1;
      const int chain = trace.crossings[events[at].crossing].chain;
      append_chain(trace, chain, outline);
      const int out = event_of(trace.chains[chain].exit);
      const int next = (out + 1) % n;
      for (int edge = events[out].edge, left = corners_between(out, next); left > 0; --left) {
        edge = (edge + 1) % 3;
        outline.push_back(corner(edge));
      }
      at = next;
    }
    polygons.solid_area += polygon_area(outline);
  }
  return true;
}

} // namespace undula::geometry
