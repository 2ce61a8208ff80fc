#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <memory>

#include "apps/python/module.hpp"
#include "apps/python/numpy_views.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/curve/measured_curve.hpp"

namespace undula::python {
namespace {

/// All datasets below `group`, as paths.
void collect(const Hdf5File& file, const std::string& group, std::vector<std::string>& names) {
  for (const auto& child : file.children(group)) {
    const std::string path = group == "/" ? child : group + "/" + child;
    if (file.content(path) == Hdf5File::Content::group)
      collect(file, path, names);
    else
      names.push_back(path);
  }
}

template <class T>
py::array_t<T> shaped(const Hdf5File& file, const std::string& name) {
  const auto values = file.read<T>(name);
  const auto extents = file.extents(name);
  return py::array_t<T>(std::vector<py::ssize_t>(extents.begin(), extents.end()), values.data());
}

py::object read(const Hdf5File& file, const std::string& name) {
  switch (file.content(name)) {
    case Hdf5File::Content::real:
      return shaped<double>(file, name);
    case Hdf5File::Content::integer:
      return shaped<std::int64_t>(file, name);
    case Hdf5File::Content::text:
      return py::str(file.read_text(name));
    case Hdf5File::Content::group:
    case Hdf5File::Content::other:
      break;
  }
  throw InputError("'" + name + "' holds neither numbers nor a text", "a group, or another type",
                   "a name that names() lists", file.path().string());
}

} // namespace

void add_files(py::module_& module) {
  py::class_<Hdf5File>(
      module, "Hdf5File",
      "An HDF5 file that Undula wrote (model, fields, checkpoint), open for reading. Its seal is "
      "compared first: a file that was changed is refused.")
      .def(py::init([](const std::filesystem::path& file) {
             return std::make_unique<Hdf5File>(Hdf5File::open_read(file));
           }),
           py::arg("file"), "Raises InputError for a missing, damaged or foreign file.")
      .def(
          "names",
          [](const Hdf5File& file) {
            std::vector<std::string> names;
            collect(file, "/", names);
            return names;
          },
          "Paths of all datasets.")
      .def("read", &read, py::arg("name"),
           "A dataset as an array (float64 or int64, in its shape) or a text. Raises InputError for other "
           "names.")
      .def(
          "attribute",
          [](const Hdf5File& file, const std::string& object, const std::string& name) {
            return file.read_attribute<int>(object, name);
          },
          py::arg("object"), py::arg("name"),
          "A whole number that is attached to a group or a dataset. Raises InputError for other names.")
      .def("unit", &Hdf5File::unit, py::arg("name"), "Unit of a dataset, \"\" where none is stated.")
      .def_property_readonly("sealed", &Hdf5File::sealed,
                             "Whether the file carries a seal; files of other programs do not.");

  py::class_<rom::MeasuredCurve>(
      module, "MeasuredCurve",
      "Measured samples of a head-flow curve, sorted by head, and a parabola through "
      "them.")
      .def_property_readonly(
          "head_mmHg", [](const rom::MeasuredCurve& curve) { return array_of(curve.head_mmHg); },
          "Heads of the samples, mmHg.")
      .def_property_readonly(
          "flow_l_per_min", [](const rom::MeasuredCurve& curve) { return array_of(curve.flow_l_per_min); },
          "Flows of the samples, l/min.")
      .def_readonly("frequency_Hz", &rom::MeasuredCurve::frequency_Hz,
                    "Hz; None where the file does not say.")
      .def_readonly("stroke_mm", &rom::MeasuredCurve::stroke_mm, "mm; None where the file does not say.")
      .def_readonly("voltage_V", &rom::MeasuredCurve::voltage_V, "V; None where the file does not say.")
      .def_property_readonly(
          "scatter_l_per_min", [](const rom::MeasuredCurve& curve) { return curve.fit.scatter_l_per_min; },
          "Standard deviation of a sample about the fit, l/min.")
      .def(
          "fit",
          [](const rom::MeasuredCurve& curve, const Numbers& heads_mmHg) {
            std::vector<double> flows;
            for (const auto& point : rom::extract_points(curve, list_of(heads_mmHg, "heads_mmHg")))
              flows.push_back(point.fit_l_per_min);
            return array_of(flows);
          },
          py::arg("heads_mmHg"),
          "Flow of the parabola, l/min, at heads within the measured range, mmHg. Raises InputError outside.")
      .def("__len__", [](const rom::MeasuredCurve& curve) { return curve.head_mmHg.size(); });

  module.def("read_measured", &rom::read_measured_curve, py::arg("file"),
             "Reads measured points (CSV: head_mmHg,flow_l_per_min; comments state how the pump was driven). "
             "Raises InputError with file and line.");
}

} // namespace undula::python
