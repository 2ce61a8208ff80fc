#include "apps/explorer/explored_model.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/input/head_list.hpp"
#include "apps/input/reduced_model.hpp"
#include "apps/output/curve_report.hpp"
#include "fom/levels/emulated_level.hpp"
#include "fom/levels/reduced_level.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

using Json = nlohmann::ordered_json;

Json range_json(const char* name, const char* unit, double low, double high) {
  return {{"name", name}, {"unit", unit}, {"low", low}, {"high", high}};
}

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

} // namespace

ExploredModel::ExploredModel(const std::string& file, const std::vector<std::string>& data)
    : data_files_(data) {
  if (is_scene(file)) {
    throw InputError("scenes take too long to be explored", file,
                     "a reduced model or an emulator (.h5) that undula train made", "undula explore");
  }
  source_.file = file;
  if (std::filesystem::exists(file) && rom::holds_emulator(file)) {
    source_.emulator = rom::load_emulator(file);
    level_ = std::make_unique<EmulatedLevel>(*source_.emulator);
  } else {
    source_.model = read_model(file);
    level_ = std::make_unique<ReducedLevel>(*source_.model);
  }
  for (const std::string& name : data) {
    measured_.push_back(read_measured_curve(name));
  }
}

rom::TrainingBox ExploredModel::box() const {
  return source_.emulator ? rom::training_box(*source_.emulator) : source_.model->box;
}

Scene ExploredModel::scene_of(double frequency_Hz, double drive) const {
  if (source_.model) {
    return scene_of_model(*source_.model, std::filesystem::path(source_.file).stem().string(), frequency_Hz,
                          drive);
  }
  const auto stated = std::optional(drive);
  return by_voltage() ? scene_of_emulator(*source_.emulator, source_.file, frequency_Hz, {}, stated)
                      : scene_of_emulator(*source_.emulator, source_.file, frequency_Hz, stated, {});
}

std::string ExploredModel::description() const {
  const auto b = box();
  Json result = {{"model", std::filesystem::path(source_.file).filename().string()},
                 {"level", level_->name()},
                 {"unknowns", level_->unknowns()},
                 {"most_heads", most_heads},
                 {"ranges",
                  {{"frequency", range_json("frequency", "Hz", b.frequency_low_Hz, b.frequency_high_Hz)},
                   {"drive", range_json(by_voltage() ? "voltage" : "stroke", by_voltage() ? "V" : "mm",
                                        b.stroke_low_mm, b.stroke_high_mm)},
                   {"head", range_json("head", "mmHg", b.head_low_mmHg, b.head_high_mmHg)}}},
                 {"measured", Json::array()}};
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const MeasuredCurve& curve = measured_[i];
    result["measured"].push_back(
        {{"file", std::filesystem::path(data_files_[i]).filename().string()},
         {"frequency_Hz", optional_number(curve.frequency_Hz)},
         {"drive", optional_number(by_voltage() ? curve.voltage_V : curve.stroke_mm)},
         {"head_mmHg", curve.head_mmHg},
         {"flow_l_per_min", curve.flow_l_per_min}});
  }
  return result.dump();
}

std::string ExploredModel::curve(double frequency_Hz, double drive, const std::string& heads) const {
  // 1. A question within the box: the page never extrapolates.
  const auto asked = parse_heads(heads);
  if (asked.size() > most_heads) {
    throw InputError("too many heads", std::to_string(asked.size()), "at most " + std::to_string(most_heads),
                     "heads");
  }
  const rom::DriveUnit unit = by_voltage() ? rom::DriveUnit{"voltage", "V"} : rom::DriveUnit{"stroke", "mm"};
  const auto outside = rom::outside_training_box(box(), frequency_Hz, drive, asked, unit);
  if (!outside.empty()) {
    throw InputError("the explorer stays in the box of the model", outside.front(), "the ranges of the page",
                     source_.file);
  }
  const Scene scene = scene_of(frequency_Hz, drive);
  if (source_.model) {
    rom::check_operating_point(frequency_Hz, drive, asked);
  }

  // 2. The curve, as `hq` makes and prints it.
  const auto begin = std::chrono::steady_clock::now();
  const auto points = level_->curve(scene, asked);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  const PhaseTimer no_phases;
  const CurveReport report{scene,
                           level_->name(),
                           source_.file,
                           level_->unknowns(),
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
  answer["remarks"] = level_->remarks(scene, asked);
  for (const CurvePoint& point : points) {
    if (!point.periodic) {
      answer["remarks"].push_back("no periodic state at " + plain_number(point.head_mmHg) +
                                  " mmHg: " + point.reason);
    }
  }
  return answer.dump();
}

} // namespace undula::apps
