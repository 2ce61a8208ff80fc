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

constexpr int version_of_three_inputs = 1; // frequency, drive and head alone; no force, no responses
constexpr FileFormat file_format{"undula emulator", "an emulator", 2, version_of_three_inputs};
constexpr int most_inputs = 100;
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

void write_process(Hdf5File& file, const std::string& group, const GaussianProcess& process,
                   const std::string& unit) {
  const RowMajor points = process.points().transpose();
  file.write_attribute(group, "variance", process.parameters().variance);
  file.write_attribute(group, "nugget", process.parameters().nugget);
  file.write(group + "/points", std::span(points.data(), extent(points.size())),
             {extent(points.rows()), extent(points.cols())}, "1");
  write_vector(file, group + "/values", process.values(), unit);
  write_vector(file, group + "/standard_errors", process.noise(), unit);
  write_vector(file, group + "/lengths", process.parameters().lengths, "1");
}

GaussianProcess read_process(const Hdf5File& file, const std::string& group) {
  const auto extents = file.extents(group + "/points");
  if (extents.size() != 2)
    refuse("points of a quantity", std::to_string(extents.size()) + " dimensions", "2", file.path().string());
  const auto points = file.read<double>(group + "/points");
  const auto attribute = [&](const char* name) { return file.read_attribute<double>(group, name); };
  return {Eigen::Map<const RowMajor>(points.data(), static_cast<Eigen::Index>(extents[0]),
                                     static_cast<Eigen::Index>(extents[1]))
              .transpose(),
          read_vector(file, group + "/values"),
          read_vector(file, group + "/standard_errors"),
          {read_vector(file, group + "/lengths"), attribute("variance"), attribute("nugget")}};
}

void write_quantity(Hdf5File& file, const std::string& group, const EmulatedQuantity& quantity) {
  file.create_group(group);
  file.write_attribute(group, "name", quantity.name);
  file.write_attribute(group, "unit", quantity.unit);
  file.write_attribute(group, "error_factor", quantity.error_factor);
  write_process(file, group, quantity.process, quantity.unit);
}

EmulatedQuantity read_quantity(const Hdf5File& file, const std::string& group) {
  const double factor = file.read_attribute<double>(group, "error_factor");
  if (!std::isfinite(factor) || factor <= 0)
    refuse("factor of the stated error", std::to_string(factor), "a finite number > 0", file.path().string());
  return {file.read_attribute<std::string>(group, "name"), file.read_attribute<std::string>(group, "unit"),
          read_process(file, group), factor};
}

void write_response(Hdf5File& file, const std::string& group, const EmulatedResponse& response) {
  file.create_group(group);
  file.write_attribute(group, "name", response.name);
  file.write_attribute(group, "unit", response.unit);
  file.write_attribute(group, "phases", response.phases);
  file.write_attribute(group, "error", response.error);
  file.write_attribute(group, "modes", static_cast<int>(response.coefficients.size()));
  file.write(group + "/places", response.places_mm, {response.places_mm.size()}, "mm");
  write_vector(file, group + "/mean", response.mean, response.unit);
  // A column-major [value][mode] matrix is a row-major [mode][value] array.
  file.write(group + "/modes", std::span(response.modes.data(), extent(response.modes.size())),
             {extent(response.modes.cols()), extent(response.modes.rows())}, "1");
  for (std::size_t k = 0; k < response.coefficients.size(); ++k) {
    const std::string coefficient = group + "/" + std::to_string(k);
    file.create_group(coefficient);
    write_process(file, coefficient, response.coefficients[k], response.unit);
  }
}

EmulatedResponse read_response(const Hdf5File& file, const std::string& group) {
  EmulatedResponse response;
  response.name = file.read_attribute<std::string>(group, "name");
  response.unit = file.read_attribute<std::string>(group, "unit");
  response.phases = file.read_attribute<int>(group, "phases");
  response.error = file.read_attribute<double>(group, "error");
  const int modes = file.read_attribute<int>(group, "modes");
  if (modes < 0 || modes > most_quantities)
    refuse("modes of " + response.name, std::to_string(modes), "at most " + std::to_string(most_quantities),
           file.path().string());
  response.places_mm = file.read<double>(group + "/places");
  response.mean = read_vector(file, group + "/mean");
  const auto values =
      file.read<double>(group + "/modes", {static_cast<std::size_t>(modes), extent(response.mean.size())});
  response.modes = Eigen::Map<const Eigen::MatrixXd>(values.data(), response.mean.size(), modes);
  for (int k = 0; k < modes; ++k)
    response.coefficients.push_back(read_process(file, group + "/" + std::to_string(k)));
  return response;
}

void write_runs(Hdf5File& file, const std::vector<EmulatorRun>& runs, std::size_t inputs) {
  std::vector<double> points, values(runs.size());
  std::vector<int> held_out;
  for (const auto& run : runs) {
    points.insert(points.end(), run.point.begin(), run.point.end());
    held_out.push_back(run.held_out ? 1 : 0);
  }
  file.write("runs/points", points, {runs.size(), inputs});
  for (const auto& column : run_columns) {
    for (std::size_t i = 0; i < runs.size(); ++i) values[i] = runs[i].*column.value;
    file.write(std::string("runs/") + column.name, values, {runs.size()}, column.unit);
  }
  file.write("runs/held_out", held_out);
}

std::vector<EmulatorRun> read_runs(const Hdf5File& file, std::size_t inputs) {
  const auto held_out = file.read<int>("runs/held_out");
  std::vector<EmulatorRun> runs(held_out.size());
  const auto points = file.read<double>("runs/points", {runs.size(), inputs});
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(i * inputs);
    runs[i].point.assign(first, first + static_cast<std::ptrdiff_t>(inputs));
    runs[i].held_out = held_out[i] != 0;
  }
  for (const auto& column : run_columns) {
    const auto values = file.read<double>(std::string("runs/") + column.name, {runs.size()});
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i].*column.value = values[i];
  }
  return runs;
}

void check_inputs(const std::string& name, const GaussianProcess& process, Eigen::Index widths,
                  const std::string& file) {
  if (process.points().rows() != widths)
    refuse("points of " + name, std::to_string(process.points().rows()) + " inputs",
           "as many as there are ranges with a width, " + std::to_string(widths), file);
}

/// What the processes do not check themselves.
void check_meaning(const Emulator& emulator, const std::string& file) {
  Eigen::Index widths = 0;
  if (emulator.inputs.size() < point_inputs)
    refuse("inputs", std::to_string(emulator.inputs.size()), "frequency, drive, head, and others", file);
  for (const auto& run : emulator.runs)
    if (run.point.size() != emulator.inputs.size())
      refuse("point of a run", std::to_string(run.point.size()) + " numbers", "one per input", file);
  for (const auto& input : emulator.inputs) {
    if (!std::isfinite(input.low) || !std::isfinite(input.high) || input.low > input.high)
      refuse("range of " + input.name, std::to_string(input.low) + " to " + std::to_string(input.high),
             "finite numbers, the lower one first", file);
    widths += input.high > input.low;
  }
  if (emulator.quantities.empty()) refuse("quantities", "none", "the mean outflow, and others", file);
  for (const auto& quantity : emulator.quantities)
    check_inputs(quantity.name, quantity.process, widths, file);
  for (const auto& response : emulator.responses) {
    const auto size = static_cast<Eigen::Index>(response.places_mm.size()) * response.phases;
    if (response.phases < 1 || response.mean.size() != size || response.modes.rows() != size ||
        response.modes.cols() != static_cast<Eigen::Index>(response.coefficients.size()))
      refuse("values of " + response.name, std::to_string(response.mean.size()),
             "one per place and phase, for the mean and every mode", file);
    for (const auto& process : response.coefficients) check_inputs(response.name, process, widths, file);
  }
}

std::string group_of(std::size_t quantity) { return "quantities/" + std::to_string(quantity); }
std::string response_group(std::size_t response) { return "responses/" + std::to_string(response); }

} // namespace

void save_emulator(const Emulator& emulator, const std::string& name) {
  check_meaning(emulator, name);
  auto file = Hdf5File::create(name);
  write_format_version(file, file_format);
  file.write_attribute("/", "driven_by_voltage", emulator.driven_by_voltage ? 1 : 0);
  file.write_attribute("/", "force_N_per_V", emulator.force_N_per_V);
  file.create_group("inputs");
  file.write_attribute("inputs", "count", static_cast<int>(emulator.inputs.size()));
  for (std::size_t i = 0; i < emulator.inputs.size(); ++i) {
    const auto& input = emulator.inputs[i];
    const std::string range = "inputs/" + std::to_string(i);
    file.write(range, std::vector<double>{input.low, input.high}, {2}, input.unit);
    file.write_attribute(range, "name", input.name);
    file.write_attribute(range, "stated", input.stated);
  }
  file.create_group("quantities");
  file.write_attribute("quantities", "count", static_cast<int>(emulator.quantities.size()));
  for (std::size_t q = 0; q < emulator.quantities.size(); ++q)
    write_quantity(file, group_of(q), emulator.quantities[q]);
  file.create_group("responses");
  file.write_attribute("responses", "count", static_cast<int>(emulator.responses.size()));
  for (std::size_t r = 0; r < emulator.responses.size(); ++r)
    write_response(file, response_group(r), emulator.responses[r]);
  write_runs(file, emulator.runs, emulator.inputs.size());
  write_provenance(file, emulator.provenance);
  file.commit();
}

bool holds_emulator(const std::string& name) {
  return kind_of(Hdf5File::open_unchecked(name)) == file_format.kind;
}

Emulator load_emulator(const std::string& name) {
  const auto file = Hdf5File::open_sealed(name);
  const bool further = checked_version(file, file_format) != version_of_three_inputs;
  Emulator emulator;
  emulator.driven_by_voltage = file.read_attribute<int>("/", "driven_by_voltage") != 0;
  if (further) emulator.force_N_per_V = file.read_attribute<double>("/", "force_N_per_V");
  const int inputs = further ? file.read_attribute<int>("inputs", "count") : static_cast<int>(point_inputs);
  if (inputs < 0 || inputs > most_inputs)
    refuse("inputs", std::to_string(inputs), "at most " + std::to_string(most_inputs), name);
  for (std::size_t i = 0; i < static_cast<std::size_t>(inputs); ++i) {
    const std::string range = "inputs/" + std::to_string(i);
    const auto bounds = file.read<double>(range, {2});
    emulator.inputs.push_back({file.read_attribute<std::string>(range, "name"), file.unit(range), bounds[0],
                               bounds[1], further ? file.read_attribute<double>(range, "stated") : 0});
  }
  const int count = file.read_attribute<int>("quantities", "count");
  if (count < 1 || count > most_quantities)
    refuse("quantities", std::to_string(count), "1 to " + std::to_string(most_quantities), name);
  for (std::size_t q = 0; q < static_cast<std::size_t>(count); ++q)
    emulator.quantities.push_back(read_quantity(file, group_of(q)));
  const int responses = further ? file.read_attribute<int>("responses", "count") : 0;
  if (responses < 0 || responses > most_quantities)
    refuse("responses", std::to_string(responses), "at most " + std::to_string(most_quantities), name);
  for (std::size_t r = 0; r < static_cast<std::size_t>(responses); ++r)
    emulator.responses.push_back(read_response(file, response_group(r)));
  emulator.runs = read_runs(file, emulator.inputs.size());
  emulator.provenance = read_provenance(file);
  check_meaning(emulator, name);
  return emulator;
}

} // namespace undula::rom
