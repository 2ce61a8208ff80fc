// The emulator's file: kind, version, inputs, one group per quantity, the runs, provenance.
#include <cmath>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/model_file_parts.hpp"
#include "rom/emulator/emulator.hpp"

namespace undula::rom {
namespace {

constexpr FileFormat file_format{"undula emulator", "an emulator", 1};
constexpr int most_quantities = 1000;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::size_t extent(Eigen::Index n) { return static_cast<std::size_t>(n); }

[[noreturn]] void refuse(const std::string& what, const std::string& seen, const std::string& allowed,
                         const std::string& file) {
  throw InputError("the emulator is not one that training makes: " + what, seen, allowed, file);
}

struct RunColumn {
  const char* name;
  double EmulatorRun::*value;
  const char* unit;
};
constexpr RunColumn run_columns[] = {
    {"flow", &EmulatorRun::flow_l_per_min, "l/min"},
    {"standard_error", &EmulatorRun::standard_error_l_per_min, "l/min"},
    {"emulated_flow", &EmulatorRun::emulated_l_per_min, "l/min"},
    {"stated_error", &EmulatorRun::stated_error_l_per_min, "l/min"},
    {"seconds", &EmulatorRun::seconds, "s"},
};

void write_vector(Hdf5File& file, const std::string& name, const Eigen::VectorXd& values,
                  const std::string& unit) {
  file.write(name, std::span(values.data(), extent(values.size())), {extent(values.size())}, unit);
}

Eigen::VectorXd read_vector(const Hdf5File& file, const std::string& name) {
  const auto values = file.read<double>(name);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

void write_quantity(Hdf5File& file, const std::string& group, const EmulatedQuantity& quantity) {
  const auto& process = quantity.process;
  const RowMajor points = process.points().transpose();
  file.create_group(group);
  file.write_attribute(group, "name", quantity.name);
  file.write_attribute(group, "unit", quantity.unit);
  file.write_attribute(group, "error_factor", quantity.error_factor);
  file.write_attribute(group, "variance", process.parameters().variance);
  file.write_attribute(group, "nugget", process.parameters().nugget);
  file.write(group + "/points", std::span(points.data(), extent(points.size())),
             {extent(points.rows()), extent(points.cols())}, "1");
  write_vector(file, group + "/values", process.values(), quantity.unit);
  write_vector(file, group + "/standard_errors", process.noise(), quantity.unit);
  write_vector(file, group + "/lengths", process.parameters().lengths, "1");
}

EmulatedQuantity read_quantity(const Hdf5File& file, const std::string& group) {
  const auto extents = file.extents(group + "/points");
  if (extents.size() != 2)
    refuse("points of a quantity", std::to_string(extents.size()) + " dimensions", "2", file.path().string());
  const auto points = file.read<double>(group + "/points");
  const auto attribute = [&](const char* name) { return file.read_attribute<double>(group, name); };
  const double factor = attribute("error_factor");
  if (!std::isfinite(factor) || factor <= 0)
    refuse("factor of the stated error", std::to_string(factor), "a finite number > 0", file.path().string());
  GaussianProcess process(
      Eigen::Map<const RowMajor>(points.data(), static_cast<Eigen::Index>(extents[0]),
                                 static_cast<Eigen::Index>(extents[1]))
          .transpose(),
      read_vector(file, group + "/values"), read_vector(file, group + "/standard_errors"),
      {read_vector(file, group + "/lengths"), attribute("variance"), attribute("nugget")});
  return {file.read_attribute<std::string>(group, "name"), file.read_attribute<std::string>(group, "unit"),
          std::move(process), factor};
}

void write_runs(Hdf5File& file, const std::vector<EmulatorRun>& runs) {
  std::vector<double> points, values(runs.size());
  std::vector<int> held_out;
  for (const auto& run : runs) {
    points.insert(points.end(), run.point.begin(), run.point.end());
    held_out.push_back(run.held_out ? 1 : 0);
  }
  file.write("runs/points", points, {runs.size(), emulator_inputs});
  for (const auto& column : run_columns) {
    for (std::size_t i = 0; i < runs.size(); ++i) values[i] = runs[i].*column.value;
    file.write(std::string("runs/") + column.name, values, {runs.size()}, column.unit);
  }
  file.write("runs/held_out", held_out);
}

std::vector<EmulatorRun> read_runs(const Hdf5File& file) {
  const auto held_out = file.read<int>("runs/held_out");
  std::vector<EmulatorRun> runs(held_out.size());
  const auto points = file.read<double>("runs/points", {runs.size(), emulator_inputs});
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t k = 0; k < emulator_inputs; ++k) runs[i].point[k] = points[i * emulator_inputs + k];
    runs[i].held_out = held_out[i] != 0;
  }
  for (const auto& column : run_columns) {
    const auto values = file.read<double>(std::string("runs/") + column.name, {runs.size()});
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i].*column.value = values[i];
  }
  return runs;
}

/// What the processes do not check themselves.
void check_meaning(const Emulator& emulator, const std::string& file) {
  Eigen::Index widths = 0;
  for (const auto& input : emulator.inputs) {
    if (!std::isfinite(input.low) || !std::isfinite(input.high) || input.low > input.high)
      refuse("range of " + input.name, std::to_string(input.low) + " to " + std::to_string(input.high),
             "finite numbers, the lower one first", file);
    widths += input.high > input.low;
  }
  if (emulator.quantities.empty()) refuse("quantities", "none", "the mean outflow, and others", file);
  for (const auto& quantity : emulator.quantities)
    if (quantity.process.points().rows() != widths)
      refuse("points of " + quantity.name, std::to_string(quantity.process.points().rows()) + " inputs",
             "as many as there are ranges with a width, " + std::to_string(widths), file);
}

std::string group_of(std::size_t quantity) { return "quantities/" + std::to_string(quantity); }

} // namespace

void save_emulator(const Emulator& emulator, const std::string& name) {
  check_meaning(emulator, name);
  auto file = Hdf5File::create(name);
  write_format_version(file, file_format);
  file.write_attribute("/", "driven_by_voltage", emulator.driven_by_voltage ? 1 : 0);
  for (std::size_t i = 0; i < emulator.inputs.size(); ++i) {
    const auto& input = emulator.inputs[i];
    const std::string range = "inputs/" + std::to_string(i);
    file.write(range, std::vector<double>{input.low, input.high}, {2}, input.unit);
    file.write_attribute(range, "name", input.name);
  }
  file.create_group("quantities");
  file.write_attribute("quantities", "count", static_cast<int>(emulator.quantities.size()));
  for (std::size_t q = 0; q < emulator.quantities.size(); ++q)
    write_quantity(file, group_of(q), emulator.quantities[q]);
  write_runs(file, emulator.runs);
  write_provenance(file, emulator.provenance);
  file.commit();
}

bool holds_emulator(const std::string& name) {
  return kind_of(Hdf5File::open_unchecked(name)) == file_format.kind;
}

Emulator load_emulator(const std::string& name) {
  const auto file = Hdf5File::open_sealed(name);
  checked_version(file, file_format);
  Emulator emulator;
  emulator.driven_by_voltage = file.read_attribute<int>("/", "driven_by_voltage") != 0;
  for (std::size_t i = 0; i < emulator.inputs.size(); ++i) {
    const std::string range = "inputs/" + std::to_string(i);
    const auto bounds = file.read<double>(range, {2});
    emulator.inputs[i] = {file.read_attribute<std::string>(range, "name"), file.unit(range), bounds[0],
                          bounds[1]};
  }
  const int count = file.read_attribute<int>("quantities", "count");
  if (count < 1 || count > most_quantities)
    refuse("quantities", std::to_string(count), "1 to " + std::to_string(most_quantities), name);
  for (std::size_t q = 0; q < static_cast<std::size_t>(count); ++q)
    emulator.quantities.push_back(read_quantity(file, group_of(q)));
  emulator.runs = read_runs(file);
  emulator.provenance = read_provenance(file);
  check_meaning(emulator, name);
  return emulator;
}

} // namespace undula::rom
