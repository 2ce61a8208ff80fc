// Numbers on their way between NumPy and rom/.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "rom/base/error.hpp"

namespace undula::python {

namespace py = pybind11;

/// What Python gives for a list of numbers: anything NumPy makes an array of, a single number too.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws InputError for tables, and for no number at all.
inline std::vector<double> list_of(const Numbers& numbers, const std::string& name) {
  if (numbers.ndim() > 1 || numbers.size() == 0)
    throw InputError(
        name + " is no list of numbers",
        std::to_string(numbers.ndim()) + " dimensions, " + std::to_string(numbers.size()) + " values",
        "one number, or a list or array of one dimension", name);
  return {numbers.data(), numbers.data() + numbers.size()};
}

/// New arrays of their own.
inline py::array_t<double> array_of(std::span<const double> values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}
inline py::array_t<double> array_of(const Eigen::VectorXd& values) {
  return array_of(std::span(values.data(), static_cast<std::size_t>(values.size())));
}
inline py::array_t<double> array_of(const Eigen::MatrixXd& values) {
  py::array_t<double> array({values.rows(), values.cols()});
  auto to = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < values.rows(); ++i)
    for (py::ssize_t j = 0; j < values.cols(); ++j) to(i, j) = values(i, j);
  return array;
}

/// One number of every record.
template <class Record, class Value>
py::array_t<Value> column_of(const std::vector<Record>& records, Value Record::*value) {
  py::array_t<Value> array(static_cast<py::ssize_t>(records.size()));
  auto to = array.template mutable_unchecked<1>();
  for (std::size_t i = 0; i < records.size(); ++i) to(static_cast<py::ssize_t>(i)) = records[i].*value;
  return array;
}

} // namespace undula::python
