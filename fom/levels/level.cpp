#include "fom/levels/level.hpp"

#include <limits>

#include "fom/output/visual_mesh.hpp"

namespace undula::fom {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

using FiniteElements = std::unique_ptr<PreparedScene>;

std::array<Point<2>, 2> box_around(const std::vector<Point<2>>& points) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::array<Point<2>, 2> box = {Point<2>::Constant(infinity), Point<2>::Constant(-infinity)};
  for (const auto& x : points) {
    box[0] = box[0].cwiseMin(x);
    box[1] = box[1].cwiseMax(x);
  }
  return box;
}

LevelView view(const PreparedScene& prepared, const Scene& scene) {
  const auto& disc = prepared.disc;
  const auto picture = std::make_shared<const FluidPicture<2>>(fluid_picture(disc));
  LevelView view;
  view.probes = prepared.observation.probes;
  view.fluid = picture->mesh;
  view.solids = solid_picture(disc);
  const auto& background = disc.problem.background;
  for (const auto& facet : background.boundary)
    view.outlines.push_back({background.points[facet.points[0]], background.points[facet.points[1]]});
  view.membrane_box =
      box_around(disc.problem.solids.empty() ? background.points : disc.problem.solids[0].mesh.points);
  if (scene.coupling == Coupling::fixed) {
    view.fluid_fields = [&disc, picture](const State& state) { return fluid_fields(disc, *picture, state); };
  } else {
    // The discretisation follows the state, so the picture is made when it is asked for.
    view.moved_fluid = [&disc](const State&) { return moved_picture(disc).mesh; };
    view.fluid_fields = [&disc](const State& state) {
      return fluid_fields(disc, fluid_picture(disc), state);
    };
  }
  view.rows = {!scene.problem.general, scene.space == Space::plane, scene.coupling != Coupling::fixed,
               prepared.observation.general.columns};
  view.solid_fields = [&disc](const State& state) { return solid_fields(disc, state); };
  return view;
}

LevelView view(const ThinGapModel& model) {
  LevelView view;
  view.probes = membrane_probes(model, membrane_probe_count);
  view.fluid = fluid_picture(model);
  view.solids = solid_picture(model);
  for (const auto& edge : boundary_edges(view.fluid))
    view.outlines.push_back({view.fluid.points[edge[0]], view.fluid.points[edge[1]]});
  view.membrane_box = box_around(view.solids.points);
  view.fluid_fields = [&model](const State& state) { return fluid_fields(model, state); };
  view.solid_fields = [&model](const State& state) { return solid_fields(model, state); };
  return view;
}

} // namespace

PreparedLevel prepare_level(const Scene& scene, MPI_Comm comm, PhaseTimer& timer) {
  if (scene.space == Space::thin_gap) return prepare_thin_gap(scene, timer);
  return prepare_scene(scene, comm, timer);
}

int unknowns(const PreparedLevel& level) {
  return std::visit(Overloaded{[](const FiniteElements& prepared) { return prepared->disc.unknowns(); },
                               [](const ThinGapModel& model) { return unknowns(model); }},
                    level);
}

State initial_state(const PreparedLevel& level) {
  return std::visit(Overloaded{[](const FiniteElements& prepared) { return initial_state(prepared->disc); },
                               [](const ThinGapModel& model) { return initial_state(model); }},
                    level);
}

void march(PreparedLevel& level, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step) {
  std::visit(Overloaded{[&](FiniteElements& prepared) {
                          set_operating_point(*prepared, scene);
                          march(*prepared, scene, state, timer, on_step);
                        },
                        [&](ThinGapModel& model) { march(model, scene, state, timer, on_step); }},
             level);
}

LevelView view_level(const PreparedLevel& level, const Scene& scene) {
  return std::visit(Overloaded{[&](const FiniteElements& prepared) { return view(*prepared, scene); },
                               [](const ThinGapModel& model) { return view(model); }},
                    level);
}

} // namespace undula::fom
