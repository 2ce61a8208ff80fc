#include "apps/python/curves.hpp"

#include <pybind11/stl.h>

#include <sstream>

#include "apps/python/module.hpp"
#include "apps/python/numpy_views.hpp"
#include "rom/curve/curve_columns.hpp"

namespace undula::python {
namespace {

using rom::CurvePoint;

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
  for (const auto& column : rom::curve_columns()) result[column.name] = column_of(curve.points, column.value);
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
  for (const auto& column : rom::curve_columns())
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
