#include "training/calibration/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// The scene with an input moved; nothing, with the reason, where that is not allowed.
std::optional<Scene> moved(const Scene& scene, const std::string& key, double value, const char* side,
                           std::string& note) {
  try {
    return with_value(scene, key, value);
  } catch (const InputError& error) {
    note += (note.empty() ? "" : "; ") + std::string(side) + ": " + first_line(error.what());
    return std::nullopt;
  }
}

/// Flows minus those of the scene; NaN where the computation fails.
std::vector<double> change(const Scene& scene, std::span<const double> nominal, const FlowsOfScene& flows) {
  std::vector<double> result(nominal.size(), unknown);
  try {
    const std::vector<double> computed = flows(scene);
    for (std::size_t head = 0; head < nominal.size(); ++head) result[head] = computed[head] - nominal[head];
  } catch (const InputError&) { // a geometry, say, that these values make impossible
  } catch (const NumericsError&) {
  }
  return result;
}

bool is_known(double value) { return std::isfinite(value); }

/// Largest change to one side; 0 where both lead to the other.
double largest(double up, double down, double sign) {
  if (!is_known(up) && !is_known(down)) return unknown;
  double most = 0;
  for (const double side : {up, down})
    if (is_known(side)) most = std::max(most, sign * side);
  return most;
}

} // namespace

double effect_of_tolerance(const InputEffect& input, std::size_t head) {
  const double up = input.up[head], down = input.down[head];
  if (is_known(up) && is_known(down)) return (up - down) / 2;
  return is_known(up) ? up : -down; // NaN where both are
}

void check_tolerances(const Scene& scene) {
  if (scene.tolerances.empty())
    throw InputError("the scene states no tolerances, so its curve has no band", "bare numbers",
                     "for instance stroke_mm = { value = 0.53, tolerance = 0.01 }, the half width of the "
                     "interval that holds the true value with 95 % probability",
                     scene.file.empty() ? "scene \"" + scene.name + '"' : scene.file.string());
}

UncertaintyBand propagate_tolerances(const Scene& scene, std::span<const double> nominal,
                                     const FlowsOfScene& flows, MPI_Comm comm, double part) {
  check_tolerances(scene);
  UncertaintyBand band;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);

  // 1. Both sides of every input, dealt out over the ranks.
  int computation = 0;
  std::vector<std::vector<double>*> computed; // the sides that are allowed
  band.inputs.resize(scene.tolerances.size());
  for (std::size_t i = 0; i < band.inputs.size(); ++i) {
    InputEffect& input = band.inputs[i];
    input.key = scene.tolerances[i].key;
    input.tolerance = scene.tolerances[i].tolerance;
    input.value = surface_value(scene, input.key);
    for (const bool upwards : {true, false}) {
      std::vector<double>& side = upwards ? input.up : input.down;
      const double value = input.value + (upwards ? part : -part) * input.tolerance;
      const auto there = moved(scene, input.key, value, upwards ? "+" : "-", input.note);
      if (!there) {
        side.assign(nominal.size(), unknown);
        continue;
      }
      // Zero on the ranks that leave it to another, for the sum below.
      side.assign(nominal.size(), 0.0);
      if (computation++ % ranks == rank) side = change(*there, nominal, flows);
      computed.push_back(&side);
    }
  }

  // 2. Every rank gets all of them.
  for (std::vector<double>* side : computed) {
    MPI_Allreduce(MPI_IN_PLACE, side->data(), static_cast<int>(side->size()), MPI_DOUBLE, MPI_SUM, comm);
    for (double& flow_change : *side) flow_change /= part;
  }
  for (InputEffect& input : band.inputs)
    if (input.note.empty() &&
        !(std::ranges::all_of(input.up, is_known) && std::ranges::all_of(input.down, is_known)))
      input.note = "the numerics fail at some heads";

  // 3. Independent inputs: squares add up.
  for (std::size_t head = 0; head < nominal.size(); ++head) {
    double width = 0, low = 0, high = 0;
    for (const InputEffect& input : band.inputs) {
      const double up = input.up[head], down = input.down[head];
      width = std::hypot(width, effect_of_tolerance(input, head));
      low = std::hypot(low, largest(up, down, -1));
      high = std::hypot(high, largest(up, down, 1));
    }
    band.half_width.push_back(width);
    band.low.push_back(low);
    band.high.push_back(high);
  }
  return band;
}

} // namespace undula::training
