// The parts of the extension module undula._rom. Each adds its classes to the module.
#pragma once

#include <pybind11/pybind11.h>

namespace undula::python {

void add_errors(pybind11::module_& module);
void add_curves(pybind11::module_& module);
void add_models(pybind11::module_& module);
void add_files(pybind11::module_& module);

/// Raises KeyboardInterrupt (or what another signal's handler raises) if one is pending. Takes the
/// interpreter's lock itself: called from computations that run without it.
void check_signals();

/// A Python warning of the category undula.CurveWarning. Throws where warnings are errors.
void warn(const std::string& sentence);

} // namespace undula::python
