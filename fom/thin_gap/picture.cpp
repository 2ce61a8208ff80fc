#include <numbers>

#include "fom/thin_gap/step.hpp"
#include "fom/thin_gap/thin_gap.hpp"

namespace undula::fom {

namespace {

/// A strip of triangles along the nodes [0, count) between two heights.
template <typename Low, typename High>
void add_strip(FieldMesh<2>& mesh, const ThinGapLayout& layout, int count, const Low& low, const High& high) {
  const int first = static_cast<int>(mesh.points.size());
  for (int node = 0; node < count; ++node) {
    mesh.points.emplace_back(layout.radius[node], low(node));
    mesh.points.emplace_back(layout.radius[node], high(node));
  }
  for (int node = 0; node + 1 < count; ++node) {
    const int at = first + 2 * node;
    mesh.cells.push_back({at, at + 2, at + 3});
    mesh.cells.push_back({at, at + 3, at + 1});
  }
}

int upper_nodes(const ThinGapLayout& layout) { return layout.channel; }
int lower_nodes(const ThinGapLayout& layout) { return static_cast<int>(layout.radius.size()); }

/// The middle of the membrane at rest is drawn at z = 0.
double skin(const ThinGapLayout& layout, int node) { return 0.5 * layout.thickness[node]; }

/// One value per node of the upper strip, then of the lower one, each for both rows of points.
template <typename Upper, typename Lower>
std::vector<double> on_strips(const ThinGapLayout& layout, const Upper& upper, const Lower& lower) {
  std::vector<double> values;
  const auto add = [&](double value) { values.insert(values.end(), 2, value); };
  for (int node = 0; node < upper_nodes(layout); ++node) add(upper(node));
  for (int node = 0; node < lower_nodes(layout); ++node) add(lower(node));
  return values;
}

} // namespace

FieldMesh<2> fluid_picture(const ThinGapModel& model) {
  const auto& layout = model.layout;
  FieldMesh<2> mesh;
  add_strip(
      mesh, layout, upper_nodes(layout), [&](int i) { return skin(layout, i); },
      [&](int i) { return skin(layout, i) + layout.upper_height[i]; });
  add_strip(
      mesh, layout, lower_nodes(layout), [&](int i) { return -skin(layout, i) - layout.lower_height[i]; },
      [&](int i) { return -skin(layout, i); });
  return mesh;
}

FieldMesh<2> solid_picture(const ThinGapModel& model) {
  const auto& layout = model.layout;
  FieldMesh<2> mesh;
  add_strip(
      mesh, layout, lower_nodes(layout), [&](int i) { return -skin(layout, i); },
      [&](int i) { return skin(layout, i); });
  return mesh;
}

std::vector<NodalField> fluid_fields(const ThinGapModel& model, const State& state) {
  const auto& layout = model.layout;
  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  const auto &x = state.x[0], &d = state.d[0];
  // Flows through faces over areas at nodes; the height below which solids touch does not matter to a
  // picture.
  const auto speed = [&](double flow_before, double flow_behind, int node, double height) {
    return 0.5 * (flow_before + flow_behind) / (2 * std::numbers::pi * layout.radius[node] * height);
  };
  std::vector<double> radial = on_strips(
      layout,
      [&](int i) {
        return speed(x[at.upper_flow(i)], x[at.upper_flow(i + 1)], i,
                     upper_height(layout, i, d[at.deflection(i)]));
      },
      [&](int i) {
        return speed(x[at.lower_flow(i)], x[at.lower_flow(i + 1)], i,
                     lower_height(layout, i, d[at.deflection(i)]));
      });
  std::vector<double> velocity;
  for (const double u : radial) velocity.insert(velocity.end(), {u, 0.0});
  return {{"velocity", "cm/s", 2, std::move(velocity)},
          {"pressure", "dyn/cm^2", 1,
           on_strips(
               layout, [&](int i) { return x[at.upper_pressure(i)]; },
               [&](int i) { return x[at.lower_pressure(i)]; })},
          {"height", "cm", 1,
           on_strips(
               layout, [&](int i) { return upper_height(layout, i, d[at.deflection(i)]); },
               [&](int i) { return lower_height(layout, i, d[at.deflection(i)]); })}};
}

std::vector<NodalField> solid_fields(const ThinGapModel& model, const State& state) {
  const auto& layout = model.layout;
  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  const auto on_section = [&](const char* name, const char* unit, const Eigen::VectorXd& values, int first) {
    NodalField field{name, unit, 2, {}};
    const int stride = first == 0 ? ThinGapUnknowns::displacements_per_node : ThinGapUnknowns::per_node;
    for (int node = 0; node < at.nodes; ++node) {
      const double w = values[first + stride * node], theta = values[first + stride * node + 1],
                   u = values[first + stride * node + 2];
      for (const double z : {-skin(layout, node), skin(layout, node)})
        field.values.insert(field.values.end(), {u - z * theta, w}); // straight normals
    }
    return field;
  };
  return {on_section("displacement", "cm", state.d[0], 0),
          on_section("velocity", "cm/s", state.x[0], at.deflection_rate(0))};
}

} // namespace undula::fom
