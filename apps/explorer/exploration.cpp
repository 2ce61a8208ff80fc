#include "apps/explorer/exploration.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/input/head_list.hpp"
#include "apps/output/curve_report.hpp"
#include "fom/levels/hybrid_level.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json numbers(const Eigen::VectorXd& values) {
  return Json(std::vector<double>(values.begin(), values.end()));
}

/// A level that somebody else keeps: tiers are put together anew for every question.
class BorrowedLevel final : public Level {
public:
  explicit BorrowedLevel(Level& level) : level_(level) {}
  [[nodiscard]] std::string name() const override { return level_.name(); }
  [[nodiscard]] int unknowns() const override { return level_.unknowns(); }
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point) override {
    return level_.curve(scene, heads_mmHg, on_point);
  }
  [[nodiscard]] std::vector<std::string> remarks(const Scene& scene,
                                                 std::span<const double> heads_mmHg) const override {
    return level_.remarks(scene, heads_mmHg);
  }

private:
  Level& level_;
};

} // namespace

Exploration::Exploration(const std::vector<std::string>& models, const std::vector<std::string>& data)
    : data_files_(data) {
  for (const std::string& file : models) {
    models_.emplace_back(file);
  }
  if (models_.empty()) {
    throw InputError("nothing is there to be explored", "no model", "a model file (.h5)", "undula explore");
  }
  for (const std::string& name : data) {
    measured_.push_back(read_measured_curve(name));
  }
}

std::string Exploration::description() const {
  Json result = {{"models", Json::array()}, {"measured", Json::array()}, {"most_heads", most_heads}};
  for (const ExploredModel& model : models_) {
    result["models"].push_back(model.description());
  }
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const MeasuredCurve& curve = measured_[i];
    result["measured"].push_back({{"file", std::filesystem::path(data_files_[i]).filename().string()},
                                  {"frequency_Hz", optional_number(curve.frequency_Hz)},
                                  {"stroke", optional_number(curve.stroke_mm)},
                                  {"voltage", optional_number(curve.voltage_V)},
                                  {"head_mmHg", curve.head_mmHg},
                                  {"flow_l_per_min", curve.flow_l_per_min}});
  }
  return result.dump();
}

const ExploredModel& Exploration::at(std::size_t model) const {
  if (model >= models_.size()) {
    throw InputError("there is no such model", std::to_string(model),
                     "0 to " + std::to_string(models_.size() - 1), "model");
  }
  return models_[model];
}

std::unique_ptr<Level> Exploration::tiers_from(std::size_t model, double frequency_Hz, double drive,
                                               double tolerance) const {
  if (!(tolerance > 0)) {
    throw InputError("the tolerance is no error", plain_number(tolerance) + " l/min", "a number > 0",
                     "tolerance");
  }
  std::vector<Tier> tiers;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const ExploredModel& other = models_[(model + i) % models_.size()];
    if (other.by_voltage() == models_[model].by_voltage()) {
      tiers.push_back({std::filesystem::path(other.file()).filename().string(),
                       other.scene_of(frequency_Hz, drive),
                       [&other] { return std::make_unique<BorrowedLevel>(other.level()); }});
    }
  }
  return std::make_unique<HybridLevel>(std::move(tiers), tolerance);
}

std::string Exploration::curve(std::size_t index, double frequency_Hz, double drive, const std::string& heads,
                               const std::optional<double>& tolerance) const {
  // 1. A question within the box: the page never extrapolates.
  const ExploredModel& model = at(index);
  const auto asked = parse_heads(heads);
  if (asked.size() > most_heads) {
    throw InputError("too many heads", std::to_string(asked.size()), "at most " + std::to_string(most_heads),
                     "heads");
  }
  model.require_inside(frequency_Hz, drive, asked);
  const Scene scene = model.scene_of(frequency_Hz, drive);

  // 2. The curve, as `hq` makes and prints it.
  const auto tiers = tolerance ? tiers_from(index, frequency_Hz, drive, *tolerance) : nullptr;
  Level& level = tiers ? *tiers : model.level();
  const auto begin = std::chrono::steady_clock::now();
  const auto points = level.curve(scene, asked);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  const PhaseTimer no_phases;
  const CurveReport report{scene,
                           level.name(),
                           std::filesystem::path(model.file()).filename().string(),
                           level.unknowns(),
                           points,
                           no_phases,
                           elapsed.count(),
                           nullptr,
                           nullptr,
                           "",
                           {},
                           {}};
  auto answer = Json::parse(curves_json(std::array{report}));

  // 3. What has to be known before it is believed.
  answer["remarks"] = level.remarks(scene, asked);
  for (const CurvePoint& point : points) {
    if (!point.periodic) {
      answer["remarks"].push_back("no periodic state at " + plain_number(point.head_mmHg) +
                                  " mmHg: " + point.reason);
    }
  }
  return answer.dump();
}

std::string Exploration::period(std::size_t model, double frequency_Hz, double drive,
                                double head_mmHg) const {
  const rom::PumpPeriod period = at(model).period(frequency_Hz, drive, head_mmHg);
  Json membrane = Json::array();
  for (Eigen::Index i = 0; i < period.membrane_mm.rows(); ++i) {
    membrane.push_back(numbers(period.membrane_mm.row(i).transpose()));
  }
  return Json{{"frequency_Hz", frequency_Hz},
              {"stroke_mm", drive},
              {"head_mmHg", head_mmHg},
              {"time_s", numbers(period.time_s)},
              {"outflow_l_per_min", numbers(period.outflow_l_per_min)},
              {"inflow_l_per_min", numbers(period.inflow_l_per_min)},
              {"holder_mm", numbers(period.holder_mm)},
              {"radius_mm", numbers(period.radius_mm)},
              {"membrane_mm", std::move(membrane)},
              {"periodic", period.periodic}}
      .dump();
}

std::string Exploration::scene(std::size_t model, double frequency_Hz, double drive, double head_mmHg) const {
  return at(model).scene_text(frequency_Hz, drive, head_mmHg);
}

} // namespace undula::apps
