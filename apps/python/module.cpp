// undula._rom: what rom/ answers, for Python. Needs neither MPI nor PETSc.
#include "apps/python/module.hpp"

#include "rom/base/error.hpp"

namespace py = pybind11;

namespace undula::python {
namespace {

/// Set once, when the module is made; lives as long as the interpreter.
PyObject* curve_warning = nullptr;

} // namespace

void add_errors(py::module_& module) {
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError).doc() =
      "What was given is wrong. The message says what, the value seen, what is allowed, and where.";
  py::register_exception<NumericsError>(module, "NumericsError", PyExc_RuntimeError).doc() =
      "The numerics failed. The message says what, at which point, and what to try.";
  curve_warning = PyErr_NewExceptionWithDoc(
      "undula._rom.CurveWarning",
      "What has to be known before a curve is believed: it leaves the training box, say.", PyExc_UserWarning,
      nullptr);
  if (curve_warning == nullptr) throw py::error_already_set();
  module.attr("CurveWarning") = py::handle(curve_warning);
}

void check_signals() {
  const py::gil_scoped_acquire interpreter;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void warn(const std::string& sentence) {
  constexpr int callers_line = 1;
  if (PyErr_WarnEx(curve_warning, sentence.c_str(), callers_line) != 0) throw py::error_already_set();
}

} // namespace undula::python

PYBIND11_MODULE(_rom, module) {
  module.doc() = "Reduced models of pumps: curves, periods and errors. Import undula instead.";
  module.attr("__version__") = UNDULA_PACKAGE_VERSION;
  undula::python::add_errors(module);
  undula::python::add_curves(module);
  undula::python::add_models(module);
  undula::python::add_files(module);
}
