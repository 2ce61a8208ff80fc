#include "fom/levels/finite_element_level.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "fom/coupling/moving_stepper.hpp"
#include "fom/output/visual_mesh.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

/// What is seen at the end of a step; phase "observe".
Observation seen_at(const PreparedScene& prepared, const TimeStepper<2>& stepper, const State& state,
                    PhaseTimer& timer) {
  const auto scope = timer.measure("observe");
  return observe(prepared.disc, prepared.operators, stepper, prepared.observation, state);
}

/// The domain of the fluid is that of rest. Steps with loads or contact on skins are taken in parts where
/// they fail.
class MarchAtRest final : public Marcher {
public:
  MarchAtRest(const PreparedScene& prepared, const Scene& scene, PhaseTimer& timer)
      : prepared_(prepared),
        settings_(scene.time),
        dt_(time_step(scene)),
        timer_(timer),
        most_parts_(has_skin_forces(prepared.disc.problem) ? 1 << scene.time.motion.max_halvings : 1) {
    prepare(1);
  }

  Observation advance(State& state) override {
    const State before = state;
    const double end = (before.step + 1) * dt_;
    // After parts, the step is tried in half as many.
    int parts = before.last_step > 0 ? static_cast<int>(std::lround(dt_ / before.last_step)) / 2 : 1;
    for (parts = std::clamp(parts, 1, most_parts_);; parts *= 2) {
      if (parts != parts_) prepare(parts);
      try {
        for (int part = 1; part <= parts; ++part) {
          stepper_->advance_to(part == parts ? end : before.time + dt_ * part / parts, state);
          if (most_parts_ > 1) state.last_step = dt_ / parts;
        }
        state.step = before.step + 1;
        return seen_at(prepared_, *stepper_, state, timer_);
      } catch (const NumericsError& error) {
        state = before;
        if (2 * parts > most_parts_) throw;
        if (prepared_.operators.rank == 0)
          spdlog::warn("step {} in {} parts: {}", before.step + 1, 2 * parts, error.what());
      }
    }
  }

private:
  void prepare(int parts) {
    stepper_.emplace(prepared_.disc, prepared_.operators, settings_.scheme, dt_ / parts,
                     settings_.factor_every, timer_, settings_.newton, settings_.convection);
    parts_ = parts;
  }

  const PreparedScene& prepared_;
  SteppingSettings settings_;
  double dt_; ///< s
  PhaseTimer& timer_;
  int most_parts_, parts_ = 0;
  std::optional<TimeStepper<2>> stepper_;
};

/// The domain of the fluid follows the solids.
class MovingMarch final : public Marcher {
public:
  MovingMarch(PreparedScene& prepared, const Scene& scene, const State& state, PhaseTimer& timer)
      : prepared_(prepared),
        timer_(timer),
        stepper_(prepared.disc, prepared.operators, scene.coupling, scene.time, scene.contact,
                 time_step(scene), timer, state) {}

  Observation advance(State& state) override {
    stepper_.advance(state);
    Observation seen = seen_at(prepared_, stepper_.last_step(), state, timer_);
    seen.motion = stepper_.report();
    seen.solves = seen.motion.solves;
    return seen;
  }

private:
  PreparedScene& prepared_;
  PhaseTimer& timer_;
  MovingStepper<2> stepper_;
};

} // namespace

FiniteElementLevel::FiniteElementLevel(const Scene& scene, MPI_Comm comm, PhaseTimer& timer)
    : prepared_(prepare_scene(scene, comm, timer)),
      coupling_(scene.coupling),
      unknowns_(prepared_->disc.unknowns()),
      rest_(fom::initial_state(prepared_->disc)) {}

void FiniteElementLevel::reduce(std::shared_ptr<const ReducedSpace> space, PhaseTimer& timer) {
  prepared_->disc.reduced = std::move(space);
  prepared_->operators = build_operators(prepared_->disc, prepared_->operators.comm, timer);
}

std::string FiniteElementLevel::name() const {
  return std::string("full order, ") + coupling_name(coupling_);
}

std::vector<std::string> FiniteElementLevel::remarks(const Scene& scene, std::span<const double>) const {
  if (scene.coupling != Coupling::fixed || scene.contact.film <= 0) return {};
  return {
      "model.coupling = \"fixed\" computes on the geometry of rest: [contact] is stated and has no effect"};
}

std::unique_ptr<Marcher> FiniteElementLevel::start(const Scene& scene, const State& state,
                                                   PhaseTimer& timer) {
  set_operating_point(*prepared_, scene);
  if (coupling_ == Coupling::fixed) return std::make_unique<MarchAtRest>(*prepared_, scene, timer);
  return std::make_unique<MovingMarch>(*prepared_, scene, state, timer);
}

Eigen::VectorXd FiniteElementLevel::displacements(const State& state) const {
  return state.d[0].tail(prepared_->disc.solid_unknowns());
}

std::unique_ptr<StateMetric> FiniteElementLevel::metric() const {
  if (coupling_ != Coupling::fixed) return nullptr;
  auto metric = std::make_unique<StateMetric>();
  const Operators<2>& operators = prepared_->operators;
  metric->norm = [&operators](const Eigen::VectorXd& x) {
    Eigen::VectorXd square(1);
    square[0] = x.dot(operators.mass * x);
    sum_over_ranks(operators.comm, square);
    return std::sqrt(square[0]);
  };
  metric->root_weights = operators.mass.diagonal();
  sum_over_ranks(operators.comm, metric->root_weights);
  metric->root_weights = metric->root_weights.cwiseMax(0.0).cwiseSqrt();
  return metric;
}

LevelView FiniteElementLevel::view(const Scene& scene) const {
  const auto& disc = prepared_->disc;
  const auto picture = std::make_shared<const FluidPicture<2>>(fluid_picture(disc));
  LevelView view;
  view.probes = prepared_->observation.probes;
  view.fluid = picture->mesh;
  view.solids = solid_picture(disc);
  const auto& background = disc.problem.background;
  for (const auto& facet : background.boundary)
    view.outlines.push_back({background.points[facet.points[0]], background.points[facet.points[1]]});
  view.membrane_box =
      box_around<2>(disc.problem.solids.empty() ? background.points : disc.problem.solids[0].mesh.points);
  if (coupling_ == Coupling::fixed) {
    view.fluid_fields = [&disc, picture](const State& state) { return fluid_fields(disc, *picture, state); };
  } else {
    // The discretisation follows the state, so the picture is made when it is asked for.
    view.moved_fluid = [&disc](const State&) { return moved_picture(disc).mesh; };
    view.fluid_fields = [&disc](const State& state) {
      return fluid_fields(disc, fluid_picture(disc), state);
    };
  }
  view.rows.pump = !scene.problem.general;
  view.rows.per_depth = scene.space == Space::plane;
  view.rows.moving = coupling_ != Coupling::fixed;
  view.rows.general = prepared_->observation.general.columns;
  view.rows.recut = view.rows.pump && (coupling_ == Coupling::explicit_ || coupling_ == Coupling::implicit);
  view.rows.blood = prepared_->observation.blood.has_value();
  for (const auto& wall : prepared_->observation.walls) view.walls.push_back(wall.points);
  view.rows.elements = true;
  view.rows.voltage = scene.operating_point.drive == Drive::voltage;
  view.solid_fields = [&disc](const State& state) { return solid_fields(disc, state); };
  return view;
}

} // namespace undula::fom
