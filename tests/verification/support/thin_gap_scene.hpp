// Scenes and layouts of the thin-gap level that verification states in code.
#pragma once

#include <string>
#include <vector>

#include "fom/scene/scene_file.hpp"
#include "fom/thin_gap/thin_gap.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// The wave pump as two thin gaps and a plate, by the text of a scene.
inline Scene thin_gap_scene(const std::vector<std::string>& overrides) {
  constexpr const char* text = R"(
name = "thin gap"
model = { space = "thin-gap", coupling = "implicit", solid = "von-karman" }
geometry.profile = "wave_pump_profile.toml"
fluid = { density_g_per_cm3 = 1.0, viscosity_poise = 0.035 }
mesh = { channel_size_mm = 0.8, membrane_size_mm = 0.4 }
thin_gap = { cells = 48, contact_stiffness_dyn_per_cm3 = 1e9 }
[membrane]
density_g_per_cm3 = 1.125
young_dyn_per_cm2 = 1.686e7
poisson = 0.49
damping_time_s = 1e-4
[operating_point]
frequency_Hz = 120.0
stroke_mm = 0.53
head_mmHg = 50.0
[time]
steps_per_period = 72
periods = 8
)";
  return parse_scene(text, "scene of the test", std::string(UNDULA_SOURCE_DIR) + "/data/profiles", overrides);
}

/// Two gaps of even heights along a plate of even thickness with evenly spaced nodes: the plate is held from
/// node `clamp` on, the upper gap ends at node `channel`, and no passage resists.
inline ThinGapLayout even_layout(double inner, double outer, int cells, int clamp, int channel,
                                 double thickness, double upper, double lower) {
  ThinGapLayout layout;
  constexpr double wide = 1e12; // cm^2
  for (int i = 0; i <= cells; ++i) {
    layout.radius.push_back(inner + (outer - inner) * i / cells);
    layout.thickness.push_back(thickness);
    if (i <= channel) layout.upper_height.push_back(upper);
    layout.lower_height.push_back(lower);
  }
  layout.clamp = clamp;
  layout.channel = channel;
  layout.step = (outer - inner) / cells;
  layout.holder_area = 1;
  layout.inlet = layout.rim = layout.outlet = {0.0, 0.0, wide};
  return layout;
}

} // namespace undula::verification
