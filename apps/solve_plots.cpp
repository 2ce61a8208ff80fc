#include "apps/solve_plots.hpp"

#include <algorithm>
#include <limits>

#include "apps/plots.hpp"
#include "apps/text_table.hpp"
#include "base/units.hpp"

namespace undula {
namespace {

constexpr int phases_drawn = 8;

using Outline = std::vector<Eigen::Vector2d>;

/// Skin of the displaced solids, edge by edge.
std::vector<Outline> solid_outlines(const Discretisation<2>& disc, const Eigen::VectorXd& d) {
  std::vector<Outline> outlines;
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& mesh = disc.problem.solids[s].mesh;
    for (const auto& facet : mesh.boundary) {
      Outline edge;
      for (const int node : facet.points) {
        edge.push_back(mesh.points[node] + d.segment<2>(disc.solid_unknown(static_cast<int>(s), node, 0)));
      }
      outlines.push_back(edge);
    }
  }
  return outlines;
}

std::vector<Outline> wall_outlines(const SimplexMesh<2>& background) {
  std::vector<Outline> outlines;
  for (const auto& facet : background.boundary) {
    outlines.push_back({background.points[facet.points[0]], background.points[facet.points[1]]});
  }
  return outlines;
}

/// Box around the membrane, a little higher than its flanges are apart.
struct Window {
  Eigen::Vector2d low, high;
  [[nodiscard]] bool contains(const Eigen::Vector2d& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

Window membrane_window(const SimplexMesh<2>& membrane) {
  Window window{Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), {}};
  window.high = -window.low;
  for (const auto& x : membrane.points) {
    window.low = window.low.cwiseMin(x);
    window.high = window.high.cwiseMax(x);
  }
  const double margin = 0.1 * (window.high[0] - window.low[0]);
  window.low.array() -= margin;
  window.high.array() += margin;
  return window;
}

FieldOnTriangles field_on(const FieldMesh<2>& mesh, std::span<const std::array<int, 3>> cells,
                          const std::vector<double>& values, const char* label) {
  return {mesh.points, cells, values, label};
}

void plot_state(const std::filesystem::path& folder, const Discretisation<2>& disc, const State& state,
                const std::string& title) {
  const FluidPicture<2> picture = fluid_picture(disc);
  const auto fields = fluid_fields(disc, picture, state);
  std::vector<double> speed, pressure_mmHg;
  for (std::size_t p = 0; p < picture.mesh.points.size(); ++p) {
    speed.push_back(std::hypot(fields[0].values[2 * p], fields[0].values[2 * p + 1]));
    pressure_mmHg.push_back(units::pressure_to_mmHg(fields[1].values[p]));
  }
  std::vector<Outline> outlines = solid_outlines(disc, state.d[0]);
  const auto walls = wall_outlines(disc.problem.background);
  outlines.insert(outlines.end(), walls.begin(), walls.end());
  const auto& cells = picture.mesh.cells;
  plot_field(folder / "speed.png", title, field_on(picture.mesh, cells, speed, "speed (cm/s)"), outlines);
  plot_field(folder / "pressure.png", title, field_on(picture.mesh, cells, pressure_mmHg, "pressure (mmHg)"),
             outlines);

  const Window window = membrane_window(disc.problem.solids[0].mesh);
  std::vector<std::array<int, 3>> near;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(near), [&](const auto& cell) {
    return std::all_of(cell.begin(), cell.end(),
                       [&](int point) { return window.contains(picture.mesh.points[point]); });
  });
  std::erase_if(outlines, [&](const Outline& edge) {
    return !std::all_of(edge.begin(), edge.end(), [&](const auto& x) { return window.contains(x); });
  });
  if (!near.empty()) {
    plot_field(folder / "speed_gap.png", title + ", at the membrane",
               field_on(picture.mesh, near, speed, "speed (cm/s)"), outlines);
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
    lines.push_back({"t/T = " + shortest(static_cast<double>(after) / steps_per_period), radius_mm,
                     std::span(membrane.values).subspan(row * radius.size(), radius.size())});
  }
  plot_lines(folder / "membrane.png", title + ", last period", "radius (mm)",
             "axial displacement of the membrane (mm)", lines);
}

void plot_flow(const std::filesystem::path& folder, const TimeSeries& series, const std::string& title) {
  const auto column = [&](const std::string& name) {
    const auto found = std::find(series.columns.begin(), series.columns.end(), name);
    const auto index = static_cast<std::size_t>(found - series.columns.begin());
    std::vector<double> values;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      values.push_back(series.value(row, index));
    }
    return values;
  };
  const auto time = column("time_s"), outflow = column("outflow_l_per_min"),
             inflow = column("inflow_l_per_min");
  const std::array<Line, 2> lines = {{{"outflow", time, outflow}, {"inflow", time, inflow}}};
  plot_lines(folder / "flow.png", title, "time (s)", "flow (l/min)", lines);
}

} // namespace

void plot_run(const RunDirectory& run, const PreparedScene& prepared, const Scene& scene,
              const State& state) {
  const auto& point = scene.operating_point;
  const std::string title = scene.name + ": " + shortest(point.frequency) + " Hz, stroke " +
                            shortest(units::length_to_mm(point.stroke)) + " mm, head " +
                            shortest(units::pressure_to_mmHg(point.head)) + " mmHg";
  plot_state(run.folder(), prepared.disc, state,
             title + ", t/T = " + shortest(static_cast<double>(state.step) / scene.time.steps_per_period));
  plot_membrane(run.folder(), run.membrane(), prepared.observation.probes.radius, scene.time.steps_per_period,
                title);
  plot_flow(run.folder(), run.series(), title);
}

} // namespace undula
