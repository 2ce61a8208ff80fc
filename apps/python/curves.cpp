#include "apps/python/curves.hpp"

#include <pybind11/stl.h>

#include <sstream>

#include "apps/python/module.hpp"
#include "apps/python/numpy_views.hpp"

namespace undula::python {
namespace {

using rom::CurvePoint;

/// Names, members and help of the columns. nan: the model does not know the number.
struct RealColumn {
  const char* name;
  double CurvePoint::*value;
  const char* help;
};
constexpr RealColumn real_columns[] = {
    {"head_mmHg", &CurvePoint::head_mmHg, "Head, mmHg: pressure at the outlet minus that at the inlet."},
    {"flow_l_per_min", &CurvePoint::flow_l_per_min,
     "Mean flow out of the outlet, l/min; nan where the numerics failed."},
    {"error_l_per_min", &CurvePoint::error_l_per_min,
     "Stated error of the flow against the level that the model was made from, l/min; inf: unknown."},
    {"inflow_l_per_min", &CurvePoint::inflow_l_per_min, "Mean flow into the inlet, l/min."},
    {"spread_l_per_min", &CurvePoint::spread_l_per_min,
     "Largest minus smallest mean of the last periods, l/min; 0: periodic."},
    {"hydraulic_power_mW", &CurvePoint::power_mW, "Head times flow, mW."},
    {"holder_power_mW", &CurvePoint::holder_power_mW, "Mean power of the holder on membrane and fluid, mW."},
    {"actuator_power_mW", &CurvePoint::actuator_power_mW, "Mean mechanical power of the actuator, mW."},
    {"electrical_power_mW", &CurvePoint::electrical_power_mW,
     "Mean electrical power, with that of the coil's resistance, mW."},
    {"efficiency_percent", &CurvePoint::efficiency_percent,
     "Hydraulic power of the electrical, else the actuator's, else the holder's power, %."},
    {"holder_stroke_mm", &CurvePoint::stroke_mm, "Amplitude of the holder's motion at the frequency, mm."},
    {"clearance_min_mm", &CurvePoint::clearance_min_mm, "Least clearance of the membrane, mm."},
    {"speed_max_cm_per_s", &CurvePoint::speed_max_cm_per_s, "Greatest speed of the fluid, cm/s."},
    {"scalar_stress_max_Pa", &CurvePoint::scalar_stress_max_Pa, "Greatest scalar stress in the fluid, Pa."},
    {"stressed_volume_mm3", &CurvePoint::stressed_volume_mm3, "Fluid beyond the threshold of stress, mm^3."},
};
const char* const inside_help = "Whether the point lies in the training box, bool.";
const char* const periodic_help = "Whether the state repeats itself, bool.";

py::array_t<bool> inside_training_box(const Curve& curve) {
  py::array_t<bool> array(static_cast<py::ssize_t>(curve.points.size()));
  auto to = array.mutable_unchecked<1>();
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    to(static_cast<py::ssize_t>(i)) = curve.points[i].inside_training_box.value_or(false);
  return array;
}

py::dict columns(const Curve& curve) {
  py::dict result;
  for (const auto& column : real_columns) result[column.name] = column_of(curve.points, column.value);
  result["inside_training_box"] = inside_training_box(curve);
  result["periodic"] = column_of(curve.points, &CurvePoint::periodic);
  return result;
}

std::string text_of(const Curve& curve) {
  std::ostringstream text;
  text << "<Curve of " << curve.points.size() << " points, " << curve.level << ", " << curve.frequency_Hz
       << " Hz, ";
  if (curve.drive.voltage_V)
    text << *curve.drive.voltage_V << " V>";
  else
    text << "stroke " << *curve.drive.stroke_mm << " mm>";
  return text.str();
}

} // namespace

void add_curves(py::module_& module) {
  py::class_<Curve> type(
      module, "Curve",
      "A head-flow curve: one entry per head, in the order asked for. Arrays are copies; nan "
      "stands for what the model does not know.");
  for (const auto& column : real_columns)
    type.def_property_readonly(
        column.name, [value = column.value](const Curve& curve) { return column_of(curve.points, value); },
        column.help);
  type.def_property_readonly("inside_training_box", &inside_training_box, inside_help)
      .def_property_readonly(
          "periodic", [](const Curve& curve) { return column_of(curve.points, &CurvePoint::periodic); },
          periodic_help)
      .def_property_readonly(
          "reasons",
          [](const Curve& curve) {
            std::vector<std::string> reasons;
            for (const auto& point : curve.points) reasons.push_back(point.reason);
            return reasons;
          },
          "Why a point is not periodic; empty where it is.")
      .def_readonly("remarks", &Curve::remarks,
                    "What has to be known before the curve is believed, a sentence each; also given as "
                    "warnings of the category CurveWarning.")
      .def_readonly("level", &Curve::level, "What computed: \"reduced model\" or \"emulator\".")
      .def_readonly("frequency_Hz", &Curve::frequency_Hz, "Frequency of the actuator, Hz.")
      .def_property_readonly(
          "stroke_mm", [](const Curve& curve) { return curve.drive.stroke_mm; },
          "Amplitude of the holder's stroke, mm; None where a voltage drives.")
      .def_property_readonly(
          "voltage_V", [](const Curve& curve) { return curve.drive.voltage_V; },
          "Amplitude of the voltage, V; None where a stroke drives.")
      .def("columns", &columns, "All columns by name, for a table: {name: array}.")
      .def("__len__", [](const Curve& curve) { return curve.points.size(); })
      .def("__repr__", &text_of);
}

} // namespace undula::python
