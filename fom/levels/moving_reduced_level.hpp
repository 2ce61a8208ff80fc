// A reduced model of a moving domain behind the door: the march of the full order, projected.
#pragma once

#include <optional>

#include "fom/levels/finite_element_level.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/moving_domain/moving_model.hpp"

namespace undula::fom {

/// The scene that a model was made from, whole, at an operating point of its own: frequency, voltage, and the
/// middle of the range of heads. Its profile is that of the model; Scene::profile names no file. Throws
/// InputError for a missing voltage, a stroke, and numbers that are no operating point.
Scene scene_of_moving_model(const rom::MovingModel& model, const std::string& file, double frequency_Hz,
                            const rom::StatedDrive& drive);

/// The full order of the model's scene in its reduced space. Throws InputError where mesh and cut are not
/// those that the modes belong to. Collective over `comm`.
std::unique_ptr<FiniteElementLevel> reduced_march(const rom::MovingModel& model, const std::string& file,
                                                  MPI_Comm comm, PhaseTimer& timer);

class MovingReducedLevel final : public Level {
public:
  /// `file` is named in messages. Phases as prepare_scene. Collective over `comm`.
  MovingReducedLevel(const rom::MovingModel& model, const std::string& file, MPI_Comm comm,
                     PhaseTimer& timer);

  std::string name() const override { return "reduced model, moving domain"; }
  int unknowns() const override { return modes_; }

  /// Marched from rest at the first head, and from the state of the last at every other.
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;

  /// Parameters outside of the ranges of the runs.
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;

private:
  std::unique_ptr<FiniteElementLevel> march_;
  rom::TrainingBox box_;   ///< rom::MovingModel::box
  double error_l_per_min_; ///< of the box
  int modes_ = 0;
};

} // namespace undula::fom
