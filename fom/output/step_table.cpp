#include "fom/output/step_table.hpp"

#include <algorithm>
#include <numbers>

#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double uJ_per_erg = 0.1;
constexpr double mW_per_uJ_per_s = 1e-3;
constexpr double dyn_cm_per_N_m = 1e7;

/// Which scenes have a column: all, those of pumps, those that state a problem, those whose domain moves,
/// those whose solids move through the elements, those driven by a voltage, pumps
/// whose fluid has a resolved stress, finite elements, pumps with a membrane, with a hose, with a hose of a
/// stated modulus.
enum class In { all, pump, general, moving, recut, voltage, blood, elements, membrane, hose, hose_force };

struct Column {
  const char* name;
  double (*value)(const Observation&);
  In in = In::all;
  bool extensive = false; ///< a power or an energy: in plane space per cm of depth
};

constexpr Column columns[] = {
    {"time_s", [](const Observation& o) { return o.time; }},
    {"outflow_l_per_min", [](const Observation& o) { return units::flow_to_l_per_min(o.outflow); }, In::pump},
    {"inflow_l_per_min", [](const Observation& o) { return units::flow_to_l_per_min(o.inflow); }, In::pump},
    {"hydraulic_power_mW", [](const Observation& o) { return units::power_to_mW(o.hydraulic_power); },
     In::pump},
    {"holder_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.holder); }, In::all,
     true},
    {"boundary_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.boundary); },
     In::general, true},
    {"body_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.body); }, In::general,
     true},
    {"opening_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.opening); }, In::all,
     true},
    {"viscous_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.viscous); }, In::all,
     true},
    {"stabilisation_power_mW",
     [](const Observation& o) { return units::power_to_mW(o.energy.stabilisation); }, In::all, true},
    {"scheme_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.scheme); },
     In::elements, true},
    {"damping_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.damping); }, In::all,
     true},
    {"carried_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.carried); }, In::all,
     true},
    {"kinetic_energy_uJ", [](const Observation& o) { return uJ_per_erg * o.energy.kinetic; }, In::all, true},
    {"elastic_energy_uJ", [](const Observation& o) { return uJ_per_erg * o.energy.elastic; }, In::all, true},
    {"speed_max_cm_per_s", [](const Observation& o) { return o.speed_max; }},
    {"wall_shear_max_dyn_per_cm2", [](const Observation& o) { return o.wall_shear_max; }},
    {"wall_shear_mean_dyn_per_cm2", [](const Observation& o) { return o.wall_shear_mean; }},
    {"scalar_stress_max_Pa", [](const Observation& o) { return units::pressure_to_Pa(o.blood->maximum); },
     In::blood},
    {"stressed_volume_mm3",
     [](const Observation& o) { return units::volume_to_mm3(o.blood->stressed_volume); }, In::blood},
    {"damage_rate_cm3_per_s", [](const Observation& o) { return o.blood->damage_rate; }, In::blood},
    {"clearance_min_mm", [](const Observation& o) { return units::length_to_mm(o.clearance_min); }},
    {"tip_displacement_mm", [](const Observation& o) { return units::length_to_mm(o.tip_displacement); },
     In::membrane},
    {"holder_displacement_mm",
     [](const Observation& o) { return units::length_to_mm(o.holder.displacement); }, In::membrane},
    {"roller_angle_deg", [](const Observation& o) { return o.hose->angle * 180 / std::numbers::pi; },
     In::hose},
    {"torque_N_m", [](const Observation& o) { return o.hose->torque / dyn_cm_per_N_m; }, In::hose},
    {"leak_l_per_min", [](const Observation& o) { return units::flow_to_l_per_min(o.hose->leak); }, In::hose},
    {"outlet_pressure_mmHg",
     [](const Observation& o) { return units::pressure_to_mmHg(o.hose->outlet_pressure); }, In::hose},
    {"roller_force_N", [](const Observation& o) { return units::force_to_N(o.hose->roller_force); },
     In::hose_force},
    {"holder_velocity_cm_per_s", [](const Observation& o) { return o.holder.velocity; }, In::voltage},
    {"holder_force_N", [](const Observation& o) { return units::force_to_N(o.holder.force); }, In::voltage},
    {"voltage_V", [](const Observation& o) { return o.holder.voltage; }, In::voltage},
    {"actuator_force_N", [](const Observation& o) { return units::force_to_N(o.holder.actuator_force); },
     In::voltage},
    {"actuator_power_mW", [](const Observation& o) { return units::power_to_mW(o.holder.actuator_power); },
     In::voltage},
    {"electrical_power_mW",
     [](const Observation& o) { return units::power_to_mW(o.holder.electrical_power); }, In::voltage},
    {"solves", [](const Observation& o) { return static_cast<double>(o.solves); }, In::elements},
    {"convection_error", [](const Observation& o) { return o.convection_error; }, In::elements},
    {"contact_power_mW", [](const Observation& o) { return units::power_to_mW(o.energy.contact); },
     In::moving, true},
    {"step_parts", [](const Observation& o) { return static_cast<double>(o.motion.parts); }, In::moving},
    {"new_fluid_nodes", [](const Observation& o) { return static_cast<double>(o.motion.new_nodes); },
     In::moving},
    {"contact_nodes", [](const Observation& o) { return static_cast<double>(o.motion.contact_nodes); },
     In::moving},
    {"placements", [](const Observation& o) { return static_cast<double>(o.motion.iterations); }, In::moving},
    {"map_corrections",
     [](const Observation& o) { return static_cast<double>(o.motion.unfolding_iterations); }, In::moving},
    {"volume_ratio_min", [](const Observation& o) { return o.motion.smallest_volume_ratio; }, In::moving},
    {"film_elements", [](const Observation& o) { return o.film_elements; }, In::recut},
    {"placement_error_mm", [](const Observation& o) { return units::length_to_mm(o.motion.placement_error); },
     In::moving},
};

bool has(const RowLayout& layout, const Column& column) {
  switch (column.in) {
    case In::pump:
      return layout.pump;
    case In::general:
      return !layout.pump;
    case In::moving:
      return layout.moving;
    case In::recut:
      return layout.recut;
    case In::blood:
      return layout.blood;
    case In::voltage:
      return layout.voltage;
    case In::elements:
      return layout.elements;
    case In::membrane:
      return layout.pump && !layout.hose;
    case In::hose:
      return layout.hose;
    case In::hose_force:
      return layout.hose_force;
    case In::all:
      break;
  }
  return true;
}

/// Values of a table by the name of their column.
class Rows {
public:
  explicit Rows(const TimeSeries& table) : table_(table) {}
  double operator()(std::size_t row, const char* name) const {
    const auto found = std::find(table_.columns.begin(), table_.columns.end(), name);
    return table_.value(row, static_cast<std::size_t>(found - table_.columns.begin()));
  }

  bool has(const char* name) const {
    return std::find(table_.columns.begin(), table_.columns.end(), name) != table_.columns.end();
  }

private:
  const TimeSeries& table_;
};

} // namespace

std::vector<std::string> observation_columns(const RowLayout& layout) {
  std::vector<std::string> names;
  for (const auto& column : columns)
    if (has(layout, column))
      names.push_back(column.name + std::string(column.extensive && layout.per_depth ? "_per_cm" : ""));
  for (const auto& column : layout.general) names.push_back(column.name);
  return names;
}

std::vector<double> observation_row(const Observation& seen, const RowLayout& layout) {
  std::vector<double> values;
  for (const auto& column : columns)
    if (has(layout, column)) values.push_back(column.value(seen));
  for (std::size_t i = 0; i < layout.general.size(); ++i)
    values.push_back(seen.general[i] / layout.general[i].cgs_per_unit);
  return values;
}

std::vector<PeriodSummary> summarise_periods(const TimeSeries& table, int steps_per_period) {
  const Rows value(table);
  const auto length = static_cast<std::size_t>(steps_per_period);
  const auto stored = [&](std::size_t rows_done) {
    return rows_done == 0
               ? 0.0
               : value(rows_done - 1, "kinetic_energy_uJ") + value(rows_done - 1, "elastic_energy_uJ");
  };
  std::vector<PeriodSummary> periods;
  // A table may begin inside a run; the energy before a period is that of the row before it, or rest.
  std::size_t first = 0;
  while (first < table.rows() && table.steps[first] != 1 &&
         (first == 0 || (table.steps[first] - 1) % steps_per_period != 0))
    ++first;
  for (std::size_t begin = first; begin + length <= table.rows(); begin += length) {
    const auto mean = [&](const char* name) {
      double sum = 0;
      for (std::size_t row = begin; row < begin + length; ++row) sum += value(row, name);
      return sum / steps_per_period;
    };
    const auto extremes = [&](const char* name) {
      std::pair<double, double> result{value(begin, name), value(begin, name)};
      for (std::size_t row = begin; row < begin + length; ++row) {
        result.first = std::min(result.first, value(row, name));
        result.second = std::max(result.second, value(row, name));
      }
      return result;
    };
    PeriodSummary period;
    period.period = (table.steps[begin] - 1) / steps_per_period + 1;
    period.outflow_l_per_min = mean("outflow_l_per_min");
    period.inflow_l_per_min = mean("inflow_l_per_min");
    const auto [lowest, highest] = extremes("outflow_l_per_min");
    period.spread_l_per_min = highest - lowest;
    const double holder = mean("holder_power_mW"), opening = mean("opening_power_mW");
    period.input_power_mW = holder + std::max(opening, 0.0);
    const double duration =
        value(begin + length - 1, "time_s") - (begin == 0 ? 0.0 : value(begin - 1, "time_s"));
    const double growth = mW_per_uJ_per_s * (stored(begin + length) - stored(begin)) / duration;
    double spent = 0;
    for (const char* name : {"viscous_power_mW", "stabilisation_power_mW", "damping_power_mW",
                             "carried_power_mW", "contact_power_mW"})
      if (value.has(name)) spent += mean(name);
    const double gap = holder + opening - spent - growth;
    period.energy_gap = period.input_power_mW != 0 ? gap / period.input_power_mW : 0.0;
    if (value.has("scheme_power_mW") && period.input_power_mW != 0)
      period.scheme_loss = mean("scheme_power_mW") / period.input_power_mW;
    if (value.has("convection_error")) period.convection_error = mean("convection_error");
    period.speed_max_cm_per_s = extremes("speed_max_cm_per_s").second;
    period.clearance_min_mm = extremes("clearance_min_mm").first;
    if (value.has("film_elements")) {
      period.film_elements_min = extremes("film_elements").first;
      int thin = 0;
      for (std::size_t row = begin; row < begin + length; ++row)
        thin += !film_is_resolved(value(row, "film_elements"));
      period.film_unresolved_percent = 100.0 * thin / steps_per_period;
    }
    if (value.has("torque_N_m")) {
      TurnSummary turn;
      turn.volume_ml = units::flow_from_l_per_min(period.outflow_l_per_min) * duration; // 1 ml is 1 cm^3
      turn.leak_l_per_min = mean("leak_l_per_min");
      turn.torque_N_m = mean("torque_N_m");
      turn.torque_max_N_m = extremes("torque_N_m").second;
      const auto [least, most] = extremes("outlet_pressure_mmHg");
      turn.outlet_pressure_min_mmHg = least;
      turn.outlet_pressure_max_mmHg = most;
      if (value.has("roller_force_N")) turn.roller_force_max_N = extremes("roller_force_N").second;
      period.turn = turn;
    }
    periods.push_back(period);
  }
  return periods;
}

} // namespace undula::fom
