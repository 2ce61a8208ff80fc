#include "apps/input/scene_flow.hpp"

#include <spdlog/spdlog.h>

#include <cctype>
#include <filesystem>

#include "apps/apps.hpp"
#include "fom/levels/scene_problem.hpp"
#include "fom/machines/wave_pump/pump_checks.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {

bool is_scene_file(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return ending == ".toml";
}

void warn_of_profile(const Scene& scene) {
  for (const std::string& sentence : profile_differences(scene)) {
    spdlog::warn("{}", sentence);
  }
}

Scene read_scene_at(const std::string& file, std::vector<std::string> overrides,
                    const std::optional<double>& frequency_Hz, const std::optional<double>& stroke_mm) {
  if (frequency_Hz) {
    overrides.push_back("operating_point.frequency_Hz=" + exact_number(*frequency_Hz));
  }
  if (stroke_mm) {
    overrides.push_back("operating_point.stroke_mm=" + exact_number(*stroke_mm));
  }
  Scene scene = read_scene(file, overrides);
  require_pump(scene, "a head-flow curve");
  warn_of_profile(scene);
  return scene;
}

FlowAtHead flow_of_scene(PreparedLevel& level, const Scene& scene, const std::function<void()>& on_step) {
  return [&level, scene, &on_step](double head_mmHg) {
    Scene point = scene;
    point.operating_point.head = units::pressure_from_mmHg(head_mmHg);
    const int first_averaged = (point.time.periods - 1) * point.time.steps_per_period + 1;
    double sum = 0;
    State state = initial_state(level);
    PhaseTimer timer;
    march(level, point, state, timer, [&](const State& now, const Observation& seen) {
      if (now.step >= first_averaged) {
        sum += seen.outflow;
      }
      on_step();
    });
    return units::flow_to_l_per_min(sum / point.time.steps_per_period);
  };
}

} // namespace undula::apps
