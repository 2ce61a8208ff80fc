#include "fom/scene/outlined_problem.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double negligible = 1e-9; ///< of an area
constexpr double lost_flow = 1e-3;  ///< net flux that the discretisation could not explain, as a part

std::string square_mm(double area) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g mm^2", units::length_to_mm(units::length_to_mm(area)));
  return text;
}

class Checker {
public:
  Checker(const OutlinedProblem& problem, const NetInflow& net_inflow)
      : problem_(problem), net_inflow_(net_inflow) {
    std::vector<PlaneRegion> regions = {problem.fluid};
    for (const auto& body : problem.bodies) regions.push_back(body.outline);
    overlay_ = lay_over(regions);
    for (const auto& part : overlay_.parts)
      if (part.only_in(0)) fluid_area_ += part.area;
  }

  PlaneOverlay run() {
    check_overlaps();
    if (problem_.fluid.empty()) return std::move(overlay_);
    check_fluid_left();
    check_bodies_inside();
    check_covered_sides();
    check_closed_parts();
    return std::move(overlay_);
  }

private:
  static bool in(const OverlayPart& part, std::size_t body) { return part.inside[body + 1] != 0; }

  template <typename Counts>
  double area(const Counts& counts) const {
    double sum = 0;
    for (const auto& part : overlay_.parts)
      if (counts(part)) sum += part.area;
    return sum;
  }

  double body_area(std::size_t body) const {
    return area([&](const auto& part) { return in(part, body); });
  }

  void check_overlaps() const {
    const auto& bodies = problem_.bodies;
    const bool in_vacuo = problem_.fluid.empty();
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        const double shared = area([&](const auto& part) {
          return in(part, i) && in(part, j) && (in_vacuo || part.inside[0] != 0);
        });
        if (shared > negligible * std::min(body_area(i), body_area(j)))
          throw InputError(
              "two bodies lie over one another",
              "\"" + bodies[i].name + "\" and \"" + bodies[j].name + "\" share " + square_mm(shared),
              "bodies apart from each other in the fluid", bodies[j].where);
      }
  }

  void check_fluid_left() const {
    const double domain = area([](const auto& part) { return part.inside[0] != 0; });
    if (fluid_area_ <= negligible * domain)
      throw InputError("no fluid is left between the bodies", "bodies cover all of " + square_mm(domain),
                       "bodies that leave a part of the domain free",
                       problem_.bodies.empty() ? problem_.where : problem_.bodies.front().where);
  }

  void check_bodies_inside() const {
    for (std::size_t i = 0; i < problem_.bodies.size(); ++i) {
      if (problem_.bodies[i].may_be_dry) continue;
      const double wet = area([&](const auto& part) { return in(part, i) && part.inside[0] != 0; });
      if (wet <= negligible * body_area(i))
        throw InputError("a body lies outside of the fluid",
                         "\"" + problem_.bodies[i].name + "\" of " + square_mm(body_area(i)) +
                             " shares nothing with the domain",
                         "a body that lies in the domain at least in part, outside of holes, or has a load "
                         "or a pair; lengths in mm",
                         problem_.bodies[i].where);
    }
  }

  void check_covered_sides() const {
    std::vector<double> wet(problem_.sides.size(), 0.0), length = wet;
    for (std::size_t i = 0; i < problem_.fluid.size(); ++i)
      length[problem_.side[i]] += (problem_.fluid[i].b - problem_.fluid[i].a).norm();
    for (const auto& part : overlay_.parts)
      if (part.only_in(0))
        for (const auto& [edge, border] : part.borders)
          if (edge.first == 0) wet[problem_.side[edge.second]] += border;
    for (std::size_t s = 0; s < problem_.sides.size(); ++s)
      if (problem_.sides[s].kind != OutlinedSide::Kind::closed && length[s] > 0 &&
          wet[s] <= negligible * length[s])
        throw InputError("bodies cover a boundary that fluid is to flow through",
                         "all of \"" + problem_.sides[s].name + "\" lies in bodies",
                         "bodies that leave a part of it free", problem_.sides[s].where);
  }

  /// What bounds a part of the fluid.
  struct Surroundings {
    std::vector<int> segments; ///< of the fluid's own boundary
    std::set<int> inflows;     ///< sides with a velocity
    bool open = false;         ///< has an opening
    bool yields = false;       ///< bounded by a body that moves
  };

  Surroundings surroundings(const OverlayPart& part) const {
    Surroundings around;
    for (const auto& [edge, length] : part.borders) {
      if (edge.first > 0) {
        around.yields = around.yields || !problem_.bodies[edge.first - 1].still;
        continue;
      }
      around.segments.push_back(edge.second);
      const int side = problem_.side[edge.second];
      if (problem_.sides[side].kind == OutlinedSide::Kind::opening) around.open = true;
      if (problem_.sides[side].kind == OutlinedSide::Kind::velocity) around.inflows.insert(side);
    }
    return around;
  }

  void check_closed_parts() const {
    int parts = 0;
    for (const auto& part : overlay_.parts)
      parts += part.only_in(0) && part.area > negligible * fluid_area_ ? 1 : 0;
    for (const auto& part : overlay_.parts) {
      if (!part.only_in(0) || part.area <= negligible * fluid_area_) continue;
      const Surroundings around = surroundings(part);
      if (around.open || around.yields) continue;
      if (!around.inflows.empty() && std::abs(net_inflow_(around.segments)) > lost_flow)
        refuse_inflow(part, around);
      if (parts > 1)
        throw InputError("nothing says the pressure in a part of the fluid",
                         square_mm(part.area) + " closed all around by walls and held bodies",
                         "one part of the fluid, or an opening at each; a body may cover the part",
                         problem_.where);
    }
  }

  [[noreturn]] void refuse_inflow(const OverlayPart& part, const Surroundings& around) const {
    const auto& side = problem_.sides[*around.inflows.begin()];
    const bool blocked = std::any_of(problem_.sides.begin(), problem_.sides.end(), [](const auto& other) {
      return other.kind == OutlinedSide::Kind::opening;
    });
    throw InputError(
        blocked ? "held bodies block the way from an inflow to every opening"
                : "fluid flows in and nothing lets it out",
        "\"" + side.name + "\" into " + square_mm(part.area) + " without an opening",
        "a side of kind \"opening\" that the inflow reaches, or velocities whose flow adds up to nothing",
        side.where);
  }

  const OutlinedProblem& problem_;
  const NetInflow& net_inflow_;
  PlaneOverlay overlay_;
  double fluid_area_ = 0; ///< cm^2
};

} // namespace

PlaneOverlay check_outlines(const OutlinedProblem& problem, const NetInflow& net_inflow) {
  return Checker(problem, net_inflow).run();
}

} // namespace undula::fom
