#include "apps/output/solve_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"
#include "fom/scene/operating_point.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

constexpr int phases_drawn = 8;

using Outline = std::vector<Eigen::Vector2d>;

/// Edges of the displaced solids.
std::vector<Outline> solid_outlines(const FieldMesh<2>& solids, const NodalField& displacement) {
  const auto place = [&](int point) -> Eigen::Vector2d {
    const double* moved = &displacement.values[2 * static_cast<std::size_t>(point)];
    return solids.points[static_cast<std::size_t>(point)] + Eigen::Vector2d(moved[0], moved[1]);
  };
  std::vector<Outline> outlines;
  for (const auto& edge : boundary_edges(solids)) {
    outlines.push_back({place(edge[0]), place(edge[1])});
  }
  return outlines;
}

/// Von Mises' stress on the displaced solids.
void plot_stress(const std::filesystem::path& folder, const LevelView& view, const State& state,
                 const std::string& title) {
  const auto fields = view.solid_fields(state);
  const auto& moved = field_named(fields, "displacement").values;
  std::vector<Eigen::Vector2d> points = view.solids.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] += Eigen::Vector2d(moved[2 * i], moved[2 * i + 1]);
  }
  constexpr double dyn_per_cm2_per_MPa = 1e7;
  std::vector<double> stress = field_named(fields, "von_mises").values;
  for (double& value : stress) {
    value /= dyn_per_cm2_per_MPa;
  }
  FieldOnTriangles field{points, view.solids.cells, stress, "von Mises' stress (MPa)"};
  if (view.rows.per_depth) field.axes = {"x (cm)", "y (cm)"};
  plot_field(folder / "stress.png", title, field, {});
}

/// Box around the membrane, a little higher than its flanges are apart.
struct Window {
  Eigen::Vector2d low, high;
  [[nodiscard]] bool contains(const Eigen::Vector2d& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

Window membrane_window(const Box<2>& box) {
  const double margin = 0.1 * (box.high[0] - box.low[0]);
  return {box.low.array() - margin, box.high.array() + margin};
}

/// Length of the vectors of a field, point by point.
std::vector<double> magnitudes(const NodalField& field) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> result;
  for (std::size_t i = 0; i < field.values.size(); i += components) {
    double square = 0;
    for (std::size_t c = 0; c < components; ++c) {
      square += field.values[i + c] * field.values[i + c];
    }
    result.push_back(std::sqrt(square));
  }
  return result;
}

void plot_state(const std::filesystem::path& folder, const LevelView& view, const State& state,
                const std::string& title) {
  const FieldMesh<2> mesh = view.moved_fluid ? view.moved_fluid(state) : view.fluid;
  const auto fields = view.fluid_fields(state);
  const std::vector<double> speed = magnitudes(field_named(fields, "velocity"));
  std::vector<double> pressure_mmHg;
  for (const double pressure : field_named(fields, "pressure").values) {
    pressure_mmHg.push_back(units::pressure_to_mmHg(pressure));
  }
  std::vector<Outline> outlines =
      solid_outlines(view.solids, field_named(view.solid_fields(state), "displacement"));
  for (const auto& edge : view.outlines) {
    outlines.push_back({edge[0], edge[1]});
  }
  const auto& cells = mesh.cells;
  const auto field_on = [&](std::span<const std::array<int, 3>> triangles, const std::vector<double>& values,
                            const char* label) {
    FieldOnTriangles field{mesh.points, triangles, values, label};
    if (view.rows.per_depth || view.rows.hose) field.axes = {"x (cm)", "y (cm)"};
    return field;
  };
  plot_field(folder / "speed.png", title, field_on(cells, speed, "speed (cm/s)"), outlines);
  plot_field(folder / "pressure.png", title, field_on(cells, pressure_mmHg, "pressure (mmHg)"), outlines);

  if (view.rows.hose) {
    return;
  }
  const Window window = membrane_window(view.membrane_box);
  std::vector<std::array<int, 3>> near;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(near), [&](const auto& cell) {
    return std::all_of(cell.begin(), cell.end(),
                       [&](int point) { return window.contains(mesh.points[point]); });
  });
  std::erase_if(outlines, [&](const Outline& edge) {
    return !std::all_of(edge.begin(), edge.end(), [&](const auto& x) { return window.contains(x); });
  });
  if (!near.empty()) {
    plot_field(folder / "speed_gap.png", title + ", at the membrane", field_on(near, speed, "speed (cm/s)"),
               outlines);
  }
}

void plot_membrane(const std::filesystem::path& folder, const TimeSeries& membrane,
                   const std::vector<double>& radius, int steps_per_period, const std::string& title) {
  const std::size_t complete = membrane.rows() - membrane.rows() % static_cast<std::size_t>(steps_per_period);
  if (complete == 0) {
    return;
  }
  std::vector<double> radius_mm;
  for (const double r : radius) {
    radius_mm.push_back(units::length_to_mm(r));
  }
  std::vector<Line> lines;
  for (int k = 0; k < phases_drawn; ++k) {
    const int after = (k + 1) * steps_per_period / phases_drawn; // steps since the period began
    const std::size_t row = complete - static_cast<std::size_t>(steps_per_period - after) - 1;
    lines.push_back({"t/T = " + plain_number(static_cast<double>(after) / steps_per_period), radius_mm,
                     std::span(membrane.values).subspan(row * radius.size(), radius.size())});
  }
  plot_lines(folder / "membrane.png", title + ", last period", "radius (mm)",
             "axial displacement of the membrane (mm)", lines);
}

/// A column of a time series; empty where it has none of this name.
std::vector<double> column(const TimeSeries& series, const std::string& name) {
  const auto found = std::find(series.columns.begin(), series.columns.end(), name);
  if (found == series.columns.end()) {
    return {};
  }
  const auto index = static_cast<std::size_t>(found - series.columns.begin());
  std::vector<double> values;
  for (std::size_t row = 0; row < series.rows(); ++row) {
    values.push_back(series.value(row, index));
  }
  return values;
}

/// A holder that a voltage drives: displacement, force on membrane and fluid, force of the coil.
void plot_holder(const std::filesystem::path& folder, const TimeSeries& series, const std::string& title) {
  const auto time = column(series, "time_s"), place = column(series, "holder_displacement_mm");
  auto force = column(series, "holder_force_N"), coil = column(series, "actuator_force_N");
  if (coil.empty()) {
    return;
  }
  constexpr double parts = 10; // so that one axis serves all
  for (auto* values : {&force, &coil}) {
    for (double& value : *values) {
      value /= parts;
    }
  }
  const std::array<Line, 3> lines = {{{"displacement (mm)", time, place},
                                      {"force on membrane and fluid (10 N)", time, force},
                                      {"force of the coil (10 N)", time, coil}}};
  plot_lines(folder / "holder.png", title, "time (s)", "holder", lines);
}

/// Mean shear of the walls over the last whole period, with the solids at rest.
void plot_wall_shear(const DrawnRun& run, const std::string& title) {
  if (run.wall_shear.empty() || run.view.walls.empty()) {
    return;
  }
  std::vector<double> pascal;
  for (const double shear : run.wall_shear) {
    pascal.push_back(units::pressure_to_Pa(shear));
  }
  std::vector<Outline> solids;
  for (const auto& edge : boundary_edges(run.view.solids)) {
    solids.push_back({run.view.solids.points[static_cast<std::size_t>(edge[0])],
                      run.view.solids.points[static_cast<std::size_t>(edge[1])]});
  }
  plot_pieces(run.folder / "wall_shear.png", title + ", last period",
              {run.view.walls, pascal, "mean wall shear (Pa)"}, solids);
}

void plot_flow(const std::filesystem::path& folder, const TimeSeries& series, const std::string& title) {
  const auto time = column(series, "time_s"), outflow = column(series, "outflow_l_per_min"),
             inflow = column(series, "inflow_l_per_min");
  const std::array<Line, 2> lines = {{{"outflow", time, outflow}, {"inflow", time, inflow}}};
  plot_lines(folder / "flow.png", title, "time (s)", "flow (l/min)", lines);
}

/// Flow, torque and outlet pressure over the last two turns, and the hose as the run left it.
void plot_hose(const DrawnRun& run, const Scene& scene, const State& state) {
  const auto& point = scene.operating_point;
  const std::string title = scene.name + ": " + setting_text(point) + ", head " +
                            plain_number(units::pressure_to_mmHg(point.head)) + " mmHg";
  plot_state(run.folder, run.view, state, title);

  const auto turns = [&] {
    std::vector<double> result;
    for (const int step : run.series.steps) {
      result.push_back(static_cast<double>(step) / scene.time.steps_per_period);
    }
    return result;
  }();
  const std::size_t drawn = std::min(turns.size(), 2 * static_cast<std::size_t>(scene.time.steps_per_period));
  const auto last = [&](const std::vector<double>& values) { return std::span(values).last(drawn); };
  const auto plot = [&](const char* picture, const std::string& label,
                        std::span<const std::pair<const char*, const char*>> names) {
    std::vector<std::vector<double>> values;
    std::vector<Line> lines;
    for (const auto& [name, legend] : names) {
      values.push_back(column(run.series, name));
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!values[k].empty()) {
        lines.push_back({names[k].second, last(turns), last(values[k])});
      }
    }
    if (!lines.empty()) {
      plot_lines(run.folder / picture, title, "turns", label, lines);
    }
  };
  using Names = std::pair<const char*, const char*>;
  plot(
      "flow.png", "flow (l/min)",
      std::array<Names, 3>{
          Names{"outflow_l_per_min", "outflow"}, {"inflow_l_per_min", "inflow"}, {"leak_l_per_min", "leak"}});
  plot("torque.png", "torque (N m)", std::array<Names, 1>{Names{"torque_N_m", "torque of the rotor"}});
  plot("outlet_pressure.png", "pressure (mmHg)",
       std::array<Names, 1>{Names{"outlet_pressure_mmHg", "behind the last squeezed place"}});
  plot("roller_force.png", "force (N)",
       std::array<Names, 1>{Names{"roller_force_N", "on the roller that carries most"}});
}

} // namespace

DrawnRun drawn_run(const RunDirectory& run) {
  const bool membrane = !run.view().probes.radius.empty();
  const auto& shear = run.wall_shear();
  return {run.folder(), run.view(), run.series(), membrane ? &run.membrane() : nullptr,
          shear.has_period() ? shear.mean() : std::vector<double>()};
}

void plot_run(const DrawnRun& run, const Scene& scene, const State& state) {
  if (scene.problem.general) {
    const std::string title = scene.name + ", t = " + plain_number(state.time) + " s";
    if (has_fluid(scene.problem.domain)) plot_state(run.folder, run.view, state, title);
    if (!run.view.solids.cells.empty()) plot_stress(run.folder, run.view, state, title);
    return;
  }
  const auto& point = scene.operating_point;
  if (scene.machine == Machine::peristaltic_pump) {
    plot_hose(run, scene, state);
    return;
  }
  const std::string title = scene.name + ": " + plain_number(point.frequency) + " Hz, stroke " +
                            plain_number(units::length_to_mm(point.stroke)) + " mm, head " +
                            plain_number(units::pressure_to_mmHg(point.head)) + " mmHg";
  plot_state(
      run.folder, run.view, state,
      title + ", t/T = " + plain_number(static_cast<double>(state.step) / scene.time.steps_per_period));
  if (run.membrane != nullptr) {
    plot_membrane(run.folder, *run.membrane, run.view.probes.radius, scene.time.steps_per_period, title);
  }
  plot_flow(run.folder, run.series, title);
  plot_holder(run.folder, run.series, title);
  plot_wall_shear(run, title);
}

} // namespace undula::apps
