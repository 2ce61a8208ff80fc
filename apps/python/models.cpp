#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

#include "apps/python/curves.hpp"
#include "apps/python/module.hpp"
#include "apps/python/numpy_views.hpp"
#include "rom/base/text_file.hpp"
#include "rom/curve/mode_amplitudes.hpp"
#include "rom/curve/projected_curve.hpp"
#include "rom/curve/pump_period.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/emulator/emulated_curve.hpp"

namespace undula::python {
namespace {

using OptionalNumber = std::optional<double>;

/// A model and the file that it comes from.
struct ReducedModel {
  std::string file;
  rom::Model model;
};
struct Emulator {
  std::string file;
  rom::Emulator emulator;
};

struct Period {
  double frequency_Hz = 0, stroke_mm = 0, head_mmHg = 0;
  rom::PumpPeriod values;
};

/// Remarks of a curve: `outside` and its points that are not periodic. They are warned of as well.
Curve finished(Curve curve, std::vector<std::string> outside) {
  curve.remarks = std::move(outside);
  for (const auto& point : curve.points)
    if (!point.periodic)
      curve.remarks.push_back("no periodic state at " + plain_number(point.head_mmHg) +
                              " mmHg: " + point.reason);
  for (const auto& remark : curve.remarks) warn(curve.level + ": " + remark);
  return curve;
}

Curve curve_of(const ReducedModel& source, double frequency_Hz, const Numbers& heads_mmHg,
               const OptionalNumber& stroke_mm, const OptionalNumber& voltage_V) {
  const double stroke = rom::stroke_of_scenes(
      rom::drive_of({stroke_mm, voltage_V}, false, "a reduced model of this version", source.file));
  const auto heads = list_of(heads_mmHg, "heads_mmHg");
  Curve curve{"reduced model", frequency_Hz, {stroke_mm, {}}, {}, {}};
  {
    const py::gil_scoped_release others_run;
    curve.points = rom::projected_curve(source.model, frequency_Hz, stroke, heads, check_signals);
  }
  return finished(std::move(curve), rom::outside_training_box(source.model.box, frequency_Hz, stroke, heads));
}

Curve curve_of(const Emulator& source, double frequency_Hz, const Numbers& heads_mmHg,
               const OptionalNumber& stroke_mm, const OptionalNumber& voltage_V) {
  const auto& emulator = source.emulator;
  const bool by_voltage = emulator.driven_by_voltage;
  const double stated = rom::drive_of({stroke_mm, voltage_V}, by_voltage, "the emulator", source.file);
  const double drive = by_voltage ? stated : rom::stroke_of_scenes(stated);
  const auto heads = list_of(heads_mmHg, "heads_mmHg");
  Curve curve{"emulator", frequency_Hz, {stroke_mm, voltage_V}, {}, {}};
  {
    const py::gil_scoped_release others_run;
    curve.points = rom::emulated_curve(emulator, frequency_Hz, drive, heads, check_signals);
  }
  return finished(std::move(curve), rom::outside_training_box(emulator, frequency_Hz, drive, heads));
}

/// Remarks of one point, warned of.
void warn_of_point(const ReducedModel& source, double frequency_Hz, double head_mmHg, double stroke,
                   bool periodic) {
  for (const auto& remark :
       rom::outside_training_box(source.model.box, frequency_Hz, stroke, std::span(&head_mmHg, 1)))
    warn("reduced model: " + remark);
  if (!periodic) warn("reduced model: no periodic state was found: this is the last period of a march");
}

Period period_of(const ReducedModel& source, double frequency_Hz, double head_mmHg, double stroke_mm) {
  const double stroke = rom::stroke_of_scenes(stroke_mm);
  Period period{frequency_Hz, stroke_mm, head_mmHg, {}};
  {
    const py::gil_scoped_release others_run;
    period.values = rom::pump_period(source.model, frequency_Hz, stroke, head_mmHg);
  }
  warn_of_point(source, frequency_Hz, head_mmHg, stroke, period.values.periodic);
  return period;
}

py::dict amplitudes_of(const ReducedModel& source, double frequency_Hz, double head_mmHg, double stroke_mm) {
  const double stroke = rom::stroke_of_scenes(stroke_mm);
  rom::ModeAmplitudes amplitudes;
  {
    const py::gil_scoped_release others_run;
    amplitudes = rom::mode_amplitudes(source.model, frequency_Hz, stroke, head_mmHg);
  }
  warn_of_point(source, frequency_Hz, head_mmHg, stroke, amplitudes.periodic);
  py::dict result;
  result["time_s"] = array_of(amplitudes.time_s);
  result["velocity"] = array_of(amplitudes.velocity);
  result["pressure"] = array_of(amplitudes.pressure);
  result["displacement"] = array_of(amplitudes.displacement);
  result["holder_cm"] = array_of(amplitudes.holder_cm);
  return result;
}

py::dict box_of(const rom::TrainingBox& box, const char* drive) {
  py::dict result;
  result["frequency_Hz"] = std::pair(box.frequency_low_Hz, box.frequency_high_Hz);
  result[drive] = std::pair(box.stroke_low_mm, box.stroke_high_mm);
  result["head_mmHg"] = std::pair(box.head_low_mmHg, box.head_high_mmHg);
  return result;
}

py::dict references_of(const ReducedModel& source) {
  const auto& runs = source.model.references;
  py::dict result;
  for (const auto& [name, value] :
       {std::pair("frequency_Hz", &rom::ReferencePoint::frequency_Hz),
        std::pair("stroke_mm", &rom::ReferencePoint::stroke_mm),
        std::pair("head_mmHg", &rom::ReferencePoint::head_mmHg),
        std::pair("flow_l_per_min", &rom::ReferencePoint::flow_l_per_min),
        std::pair("spread_l_per_min", &rom::ReferencePoint::flow_spread_l_per_min),
        std::pair("model_flow_l_per_min", &rom::ReferencePoint::rom_flow_l_per_min),
        std::pair("seconds", &rom::ReferencePoint::fom_seconds)})
    result[name] = column_of(runs, value);
  result["held_out"] = column_of(runs, &rom::ReferencePoint::held_out);
  return result;
}

py::dict runs_of(const Emulator& source) {
  const auto& runs = source.emulator.runs;
  py::dict result;
  const char* drive = source.emulator.driven_by_voltage ? "voltage_V" : "stroke_mm";
  for (const auto& [name, input] :
       {std::pair("frequency_Hz", 0), std::pair(drive, 1), std::pair("head_mmHg", 2)}) {
    std::vector<double> values;
    for (const auto& run : runs) values.push_back(run.point[static_cast<std::size_t>(input)]);
    result[name] = array_of(values);
  }
  for (const auto& [name, value] :
       {std::pair("flow_l_per_min", &rom::EmulatorRun::flow_l_per_min),
        std::pair("standard_error_l_per_min", &rom::EmulatorRun::standard_error_l_per_min),
        std::pair("emulated_l_per_min", &rom::EmulatorRun::emulated_l_per_min),
        std::pair("stated_error_l_per_min", &rom::EmulatorRun::stated_error_l_per_min),
        std::pair("seconds", &rom::EmulatorRun::seconds)})
    result[name] = column_of(runs, value);
  result["held_out"] = column_of(runs, &rom::EmulatorRun::held_out);
  return result;
}

py::object load(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (std::filesystem::exists(path) && rom::holds_emulator(file))
    return py::cast(Emulator{file, rom::load_emulator(file)});
  ReducedModel loaded{file, rom::load_model(file)};
  if (!loaded.model.sealed)
    warn(file + " carries no seal: a number that changed in it since it was trained would not be noticed");
  return py::cast(std::move(loaded));
}

/// What both kinds of model have.
template <class Source>
void add_common(py::class_<Source>& type, const char* curve_help) {
  type.def("curve",
           py::overload_cast<const Source&, double, const Numbers&, const OptionalNumber&,
                             const OptionalNumber&>(&curve_of),
           py::kw_only(), py::arg("frequency_Hz"), py::arg("heads_mmHg"), py::arg("stroke_mm") = py::none(),
           py::arg("voltage_V") = py::none(), curve_help)
      .def_readonly("file", &Source::file, "The file's name as it was given.");
}

void add_period(py::module_& module) {
  const auto values = [](auto member) {
    return [member](const Period& period) { return array_of(period.values.*member); };
  };
  using rom::PumpPeriod;
  py::class_<Period>(
      module, "Period",
      "One period of the periodic state at one operating point: n_t instants from t = 0 on, at "
      "which the holder passes its middle upwards.")
      .def_readonly("frequency_Hz", &Period::frequency_Hz, "Frequency of the actuator, Hz.")
      .def_readonly("stroke_mm", &Period::stroke_mm, "Amplitude of the holder's stroke, mm.")
      .def_readonly("head_mmHg", &Period::head_mmHg, "Head, mmHg.")
      .def_property_readonly("time_s", values(&PumpPeriod::time_s), "Instants, s: n_t.")
      .def_property_readonly("outflow_l_per_min", values(&PumpPeriod::outflow_l_per_min),
                             "Flow out of the outlet, l/min: n_t.")
      .def_property_readonly("inflow_l_per_min", values(&PumpPeriod::inflow_l_per_min),
                             "Flow into the inlet, l/min: n_t.")
      .def_property_readonly("holder_mm", values(&PumpPeriod::holder_mm), "Place of the holder, mm: n_t.")
      .def_property_readonly("radius_mm", values(&PumpPeriod::radius_mm),
                             "Radii along the membrane, mm: n_radius.")
      .def_property_readonly("membrane_mm", values(&PumpPeriod::membrane_mm),
                             "Axial displacement of the membrane, mm: n_radius x n_t.")
      .def_property_readonly(
          "envelope_low_mm",
          [](const Period& period) {
            return array_of(Eigen::VectorXd(period.values.membrane_mm.rowwise().minCoeff()));
          },
          "Least displacement over the period, mm: n_radius.")
      .def_property_readonly(
          "envelope_high_mm",
          [](const Period& period) {
            return array_of(Eigen::VectorXd(period.values.membrane_mm.rowwise().maxCoeff()));
          },
          "Greatest displacement over the period, mm: n_radius.")
      .def_property_readonly(
          "periodic", [](const Period& period) { return period.values.periodic; },
          "False: the last period of a march that does not repeat.")
      .def("__repr__", [](const Period& period) {
        std::ostringstream text;
        text << "<Period of " << period.values.time_s.size() << " instants, " << period.frequency_Hz
             << " Hz, stroke " << period.stroke_mm << " mm, " << period.head_mmHg << " mmHg>";
        return text.str();
      });
}

} // namespace

void add_models(py::module_& module) {
  add_period(module);

  py::class_<ReducedModel> reduced(module, "ReducedModel",
                                   "A model projected from full-order runs. Its file holds operators and "
                                   "radii along the membrane; mesh and modes, "
                                   "which undula.fields draws, only where `undula train --fields` made it.");
  add_common(
      reduced,
      "Head-flow curve at one frequency (Hz) and stroke (mm): the periodic state at every head (mmHg; a "
      "number or a list). Raises InputError for what is no operating point, and for a voltage; warns "
      "(CurveWarning) outside of the training box. Can be interrupted between heads.");
  reduced
      .def("period", &period_of, py::kw_only(), py::arg("frequency_Hz"), py::arg("head_mmHg"),
           py::arg("stroke_mm"),
           "Flows, holder and membrane over one period at a frequency (Hz), head (mmHg) and stroke (mm). "
           "Raises InputError as curve, NumericsError where there is no finite state.")
      .def("mode_amplitudes", &amplitudes_of, py::kw_only(), py::arg("frequency_Hz"), py::arg("head_mmHg"),
           py::arg("stroke_mm"),
           "Amplitudes of the modes over one period, {name: array}: \"velocity\", \"pressure\" and "
           "\"displacement\" "
           "(modes x instants), \"time_s\" and \"holder_cm\" (instants). undula.fields makes fields of them. "
           "Raises and "
           "warns as period.")
      .def_property_readonly(
          "training_box", [](const ReducedModel& source) { return box_of(source.model.box, "stroke_mm"); },
          "Lowest and highest value of the training: {\"frequency_Hz\", \"stroke_mm\", \"head_mmHg\"}.")
      .def_property_readonly(
          "references", &references_of,
          "The full-order runs kept with the model, {name: array}; held_out: not trained on; "
          "model_flow_l_per_min: what the model said.")
      .def_property_readonly(
          "modes",
          [](const ReducedModel& source) {
            const auto& o = source.model.operators;
            py::dict modes;
            modes["velocity"] = o.velocity_modes;
            modes["pressure"] = o.pressure_modes;
            modes["displacement"] = o.displacement_modes;
            return modes;
          },
          "Number of modes of each field; supremizers count as velocity.")
      .def_property_readonly(
          "provenance", [](const ReducedModel& source) { return source.model.provenance; },
          "Texts on where the model comes from: scene, version, commit, date.")
      .def("__repr__", [](const ReducedModel& source) { return "<ReducedModel " + source.file + ">"; });

  py::class_<Emulator> emulator(
      module, "Emulator",
      "Mean flow, powers, stroke and clearance interpolated between runs of any level. "
      "It knows nothing of fields and of the course of a period.");
  add_common(
      emulator,
      "Head-flow curve at one frequency (Hz) and drive, the stroke (mm) or the voltage (V) that the "
      "emulator is of, over heads (mmHg; a number or a list). error_l_per_min is what nine in ten runs "
      "are within. Raises InputError for the other drive; warns (CurveWarning) outside of the box.");
  emulator
      .def_property_readonly(
          "training_box",
          [](const Emulator& source) {
            return box_of(rom::training_box(source.emulator),
                          source.emulator.driven_by_voltage ? "voltage_V" : "stroke_mm");
          },
          "Lowest and highest value of the runs: {\"frequency_Hz\", \"stroke_mm\" or \"voltage_V\", "
          "\"head_mmHg\"}.")
      .def_property_readonly(
          "runs", &runs_of,
          "The runs that it knows, {name: array}; emulated_l_per_min: what it says of each "
          "when left out.")
      .def_property_readonly(
          "quantities",
          [](const Emulator& source) {
            std::vector<std::string> names;
            for (const auto& quantity : source.emulator.quantities) names.push_back(quantity.name);
            return names;
          },
          "Names of what it interpolates, with units.")
      .def_property_readonly(
          "provenance", [](const Emulator& source) { return source.emulator.provenance; },
          "Texts on where the emulator comes from: scene, version, commit, date.")
      .def("__repr__", [](const Emulator& source) { return "<Emulator " + source.file + ">"; });

  module.def(
      "load", &load, py::arg("file"),
      "Reads a model file (HDF5) made by `undula train`: a ReducedModel or an Emulator. Raises InputError "
      "for a missing, damaged or foreign file.");
}

} // namespace undula::python
