#include "fom/levels/reduced_level.hpp"

#include <chrono>

#include "rom/base/units.hpp"
#include "rom/curve/projected_curve.hpp"

namespace undula::fom {
namespace {

/// The holder's stroke, mm: a reduced model knows no scale of its own.
double stroke_mm(const Scene& scene) {
  return units::length_to_mm(scene.operating_point.stroke * scene.operating_point.stroke_scale);
}

} // namespace

int ReducedLevel::unknowns() const {
  const auto& sizes = model_.operators;
  return sizes.velocity_modes + sizes.pressure_modes + sizes.displacement_modes;
}

std::vector<CurvePoint> ReducedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                            const std::function<void()>& on_point) {
  const auto begin = std::chrono::steady_clock::now();
  auto points =
      rom::projected_curve(model_, scene.operating_point.frequency, stroke_mm(scene), heads_mmHg, on_point);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  for (auto& point : points) {
    point.seconds["total"] = elapsed.count() / static_cast<double>(points.size());
  }
  return points;
}

std::vector<std::string> ReducedLevel::remarks(const Scene& scene, std::span<const double> heads_mmHg) const {
  return rom::outside_training_box(model_.box, scene.operating_point.frequency, stroke_mm(scene), heads_mmHg);
}

Scene scene_of_model(const rom::Model& model, const std::string& name, double frequency_Hz,
                     double stroke_mm) {
  Scene scene;
  scene.name = name;
  scene.operating_point.frequency = frequency_Hz;
  scene.operating_point.stroke = units::length_from_mm(stroke_mm);
  const auto& box = model.box;
  scene.operating_point.head = units::pressure_from_mmHg((box.head_low_mmHg + box.head_high_mmHg) / 2);
  scene.training.frequency_low = box.frequency_low_Hz;
  scene.training.frequency_high = box.frequency_high_Hz;
  scene.training.stroke_low = units::length_from_mm(box.stroke_low_mm);
  scene.training.stroke_high = units::length_from_mm(box.stroke_high_mm);
  scene.training.head_low = units::pressure_from_mmHg(box.head_low_mmHg);
  scene.training.head_high = units::pressure_from_mmHg(box.head_high_mmHg);
  return scene;
}

} // namespace undula::fom
