// The model file: kind, version, one dataset per operator with its unit, the reference runs, provenance.
#include <cmath>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/model_file_parts.hpp"
#include "rom/fixed_domain/field_bases.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::rom {
namespace {

constexpr int unsealed_version = 1; // the same without seal
constexpr FileFormat file_format{"undula reduced model", "a reduced model", 2, unsealed_version};
constexpr int most_modes = 100000; // of a field; keeps sums and products of sizes far from overflow

using Shape = Hdf5File::Shape;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::size_t extent(Eigen::Index n) { return static_cast<std::size_t>(n); }

/// One visitor for writing and reading, so that the two cannot drift apart.
class Writer {
public:
  explicit Writer(Hdf5File& file) : file_(file) {}

  void operator()(const std::string& name, const Eigen::MatrixXd& matrix, Eigen::Index rows,
                  Eigen::Index columns, const std::string& unit) {
    check(name, matrix.rows() == rows && matrix.cols() == columns);
    check_finite(name, matrix);
    const RowMajor values = matrix;
    file_.write(name, std::span(values.data(), extent(values.size())),
                {extent(values.rows()), extent(values.cols())}, unit);
  }
  void operator()(const std::string& name, const Eigen::VectorXd& vector, Eigen::Index size,
                  const std::string& unit) {
    check(name, vector.size() == size);
    check_finite(name, vector);
    file_.write(name, std::span(vector.data(), extent(vector.size())), {extent(vector.size())}, unit);
  }
  void operator()(const std::string& name, const std::vector<Eigen::MatrixXd>& tensor, Eigen::Index n,
                  const std::string& unit) {
    check(name, std::ssize(tensor) == n);
    std::vector<double> values;
    values.reserve(extent(n * n * n));
    for (const auto& slice : tensor) {
      check(name, slice.rows() == n && slice.cols() == n);
      check_finite(name, slice);
      const RowMajor rows = slice;
      values.insert(values.end(), rows.data(), rows.data() + rows.size());
    }
    file_.write(name, values, {extent(n), extent(n), extent(n)}, unit);
  }

private:
  void check(const std::string& name, bool fits) const {
    if (!fits)
      throw InputError("'" + name + "' does not fit the numbers of modes", "another size",
                       "the sizes stated in rom/fixed_domain/model.hpp", file_.path().string());
  }
  template <class Values>
  void check_finite(const std::string& name, const Values& values) const {
    if (!values.allFinite())
      throw InputError("'" + name + "' holds a number that is not finite", "nan or inf", "finite numbers",
                       file_.path().string());
  }
  Hdf5File& file_;
};

class Reader {
public:
  explicit Reader(const Hdf5File& file) : file_(file) {}

  void operator()(const std::string& name, Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns,
                  const std::string&) {
    const auto values = finite(name, {extent(rows), extent(columns)});
    matrix = Eigen::Map<const RowMajor>(values.data(), rows, columns);
  }
  void operator()(const std::string& name, Eigen::VectorXd& vector, Eigen::Index size, const std::string&) {
    const auto values = finite(name, {extent(size)});
    vector = Eigen::Map<const Eigen::VectorXd>(values.data(), size);
  }
  void operator()(const std::string& name, std::vector<Eigen::MatrixXd>& tensor, Eigen::Index n,
                  const std::string&) {
    const auto values = finite(name, {extent(n), extent(n), extent(n)});
    tensor.clear();
    for (Eigen::Index k = 0; k < n; ++k)
      tensor.emplace_back(Eigen::Map<const RowMajor>(values.data() + k * n * n, n, n));
  }

private:
  std::vector<double> finite(const std::string& name, const Shape& shape) const {
    auto values = file_.read<double>(name, shape);
    for (const double value : values)
      if (!std::isfinite(value))
        throw InputError("'" + name + "' holds a number that is not finite", std::to_string(value),
                         "finite numbers", file_.path().string());
    return values;
  }
  const Hdf5File& file_;
};

/// All operators with names, sizes and units. Velocity coefficients are in cm/s of dimensionless basis
/// vectors, so the rows of u and v carry the unit of power per velocity, dyn; the mixed units of pressure
/// rows follow from that.
template <class Visitor, class SomeOperators>
void visit_operators(Visitor&& visit, SomeOperators& o, Eigen::Index probes) {
  const Eigen::Index n = o.velocity_modes + o.pressure_modes + o.displacement_modes;
  visit("operators/mass", o.mass, n, n, "g");
  visit("operators/linear", o.linear, n, n, "g/s");
  visit("operators/stiffness", o.stiffness, o.displacement_modes, o.displacement_modes, "g/s^2");
  visit("operators/convection", o.convection, o.velocity_modes, "g/cm");
  visit("operators/imposed_mass", o.imposed_mass, n, "g");
  visit("operators/imposed_linear", o.imposed_linear, n, "g/s");
  visit("operators/imposed_stiffness", o.imposed_stiffness, n, "g/s^2");
  visit("operators/head", o.head, n, "cm^2");
  visit("operators/outflow", o.outflow, o.velocity_modes, "cm^2");
  visit("operators/inflow", o.inflow, o.velocity_modes, "cm^2");
  visit("operators/envelope", o.envelope, probes, o.displacement_modes, "1");
  visit("operators/envelope_imposed", o.envelope_imposed, probes, "1");
  visit("operators/envelope_radius", o.envelope_radius, probes, "cm");
}

struct ReferenceColumn {
  const char* name;
  double ReferencePoint::*value;
  const char* unit;
};
constexpr ReferenceColumn reference_columns[] = {
    {"frequency", &ReferencePoint::frequency_Hz, "Hz"},
    {"stroke", &ReferencePoint::stroke_mm, "mm"},
    {"head", &ReferencePoint::head_mmHg, "mmHg"},
    {"flow", &ReferencePoint::flow_l_per_min, "l/min"},
    {"flow_spread", &ReferencePoint::flow_spread_l_per_min, "l/min"},
    {"rom_flow", &ReferencePoint::rom_flow_l_per_min, "l/min"},
    {"velocity_error", &ReferencePoint::velocity_error, "1"},
    {"envelope_error", &ReferencePoint::envelope_error, "1"},
    {"fom_seconds", &ReferencePoint::fom_seconds, "s"},
};

struct BoxSide {
  const char* name;
  double TrainingBox::*low;
  double TrainingBox::*high;
  const char* unit;
};
constexpr BoxSide box_sides[] = {
    {"frequency", &TrainingBox::frequency_low_Hz, &TrainingBox::frequency_high_Hz, "Hz"},
    {"stroke", &TrainingBox::stroke_low_mm, &TrainingBox::stroke_high_mm, "mm"},
    {"head", &TrainingBox::head_low_mmHg, &TrainingBox::head_high_mmHg, "mmHg"},
};

void write_references(Hdf5File& file, const std::vector<ReferencePoint>& references) {
  std::vector<double> values(references.size());
  for (const auto& column : reference_columns) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = references[i].*column.value;
    file.write(std::string("references/") + column.name, values, {values.size()}, column.unit);
  }
  std::vector<int> held_out;
  for (const auto& reference : references) held_out.push_back(reference.held_out ? 1 : 0);
  file.write("references/held_out", held_out);
}

std::vector<ReferencePoint> read_references(const Hdf5File& file) {
  const auto held_out = file.read<int>("references/held_out");
  std::vector<ReferencePoint> references(held_out.size());
  for (const auto& column : reference_columns) {
    const auto values = file.read<double>(std::string("references/") + column.name, {held_out.size()});
    for (std::size_t i = 0; i < values.size(); ++i) references[i].*column.value = values[i];
  }
  for (std::size_t i = 0; i < held_out.size(); ++i) references[i].held_out = held_out[i] != 0;
  return references;
}

int read_count(const Hdf5File& file, const std::string& object, const std::string& name, int least) {
  const int count = file.read_attribute<int>(object, name);
  if (count < least || count > most_modes)
    throw InputError("'" + name + "' is out of range", std::to_string(count),
                     std::to_string(least) + " to " + std::to_string(most_modes), file.path().string());
  return count;
}

/// What the sizes and the finiteness of the operators do not say.
void check_meaning(const Model& model, const std::string& file) {
  const auto refuse = [&](const std::string& what, const std::string& seen, const std::string& allowed) {
    throw InputError("the model is not one that training makes: " + what, seen, allowed, file);
  };
  const auto number = [](double value) { return std::to_string(value); };
  for (const auto& side : box_sides) {
    const double low = model.box.*side.low, high = model.box.*side.high;
    if (!std::isfinite(low) || !std::isfinite(high) || low > high)
      refuse(std::string("box of training in ") + side.name,
             number(low) + " to " + number(high) + " " + side.unit, "finite numbers, the lower one first");
  }
  if (model.box.frequency_low_Hz <= 0) // nothing is said of the other sides: heads may be negative
    refuse("box of training in frequency", number(model.box.frequency_low_Hz) + " Hz", "> 0");
  for (const auto& [name, value] :
       {std::pair("safety", model.error_safety), std::pair("floor (l/min)", model.error_floor_l_per_min)})
    if (!std::isfinite(value) || value < 0)
      refuse(std::string("error estimate, ") + name, number(value), "a finite number >= 0");
  for (const auto& reference : model.references) // an error relative to a fluid at rest is no number
    for (const double value :
         {reference.frequency_Hz, reference.stroke_mm, reference.head_mmHg, reference.flow_l_per_min})
      if (!std::isfinite(value)) refuse("reference runs", number(value), "finite points and flows");
  if (model.steps_per_period < 4 || model.steps_per_period > most_modes)
    refuse("steps per period", std::to_string(model.steps_per_period), "4 to " + std::to_string(most_modes));
}

/// Returns the version of the format.
int version_of(const Hdf5File& file) {
  const int version = checked_version(file, file_format);
  if (version != unsealed_version && !file.sealed())
    throw InputError("the model file has lost its seal", "a file that does not begin with one",
                     "an undamaged copy; other programs may read model files but not write them",
                     file.path().string());
  return version;
}

} // namespace

namespace {

void write_model(Hdf5File& file, const Model& model) {
  write_format_version(file, file_format);
  const auto& o = model.operators;
  file.create_group("operators");
  file.write_attribute("operators", "velocity_modes", o.velocity_modes);
  file.write_attribute("operators", "supremizer_modes", o.supremizer_modes);
  file.write_attribute("operators", "pressure_modes", o.pressure_modes);
  file.write_attribute("operators", "displacement_modes", o.displacement_modes);
  file.write_attribute("operators", "probes", static_cast<int>(o.envelope_radius.size()));
  visit_operators(Writer(file), o, o.envelope_radius.size());
  file.write("steps_per_period", std::vector<int>{model.steps_per_period}, {}, "1");
  for (const auto& side : box_sides)
    file.write(std::string("training_box/") + side.name,
               std::vector<double>{model.box.*side.low, model.box.*side.high}, {2}, side.unit);
  write_references(file, model.references);
  file.write("error_estimate/safety", std::vector<double>{model.error_safety}, {}, "1");
  file.write("error_estimate/floor", std::vector<double>{model.error_floor_l_per_min}, {}, "l/min");
  write_provenance(file, model.provenance);
}

void write_mesh(Hdf5File& file, const std::string& group, const DrawnMesh& mesh) {
  const RowMajor points = mesh.points;
  file.write(group + "/points", std::span(points.data(), extent(points.size())), {extent(points.rows()), 2},
             "cm");
  const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> cells = mesh.cells;
  file.write(group + "/cells", std::span(cells.data(), extent(cells.size())), {extent(cells.rows()), 3}, "1");
}

void write_modes(Hdf5File& file, const std::string& name, const Eigen::MatrixXd& modes, const Shape& shape,
                 const std::string& unit) {
  const RowMajor values = modes;
  file.write(name, std::span(values.data(), extent(values.size())), shape, unit);
}

void check_fields(const Model& model, const FieldBases& fields, const std::string& name) {
  const auto& o = model.operators;
  const Eigen::Index n = fields.fluid.points.rows(), k = fields.solids.points.rows();
  const auto fits = [](const Eigen::MatrixXd& modes, Eigen::Index rows, Eigen::Index columns) {
    return modes.rows() == rows && modes.cols() == columns && modes.allFinite();
  };
  const auto is_mesh = [](const DrawnMesh& mesh) {
    return mesh.points.cols() == 2 && mesh.cells.cols() == 3 && mesh.points.allFinite() &&
           mesh.cells.size() > 0 && mesh.cells.minCoeff() >= 0 && mesh.cells.maxCoeff() < mesh.points.rows();
  };
  if (!is_mesh(fields.fluid) || !is_mesh(fields.solids) || !fits(fields.velocity, 2 * n, o.velocity_modes) ||
      !fits(fields.pressure, n, o.pressure_modes) ||
      !fits(fields.displacement, 2 * k, o.displacement_modes) || !fits(fields.holder, 2 * k, 1))
    throw InputError("the fields do not fit the model", "another size, or a number that is not finite",
                     "the sizes stated in rom/fixed_domain/field_bases.hpp", name);
}

void write_fields(Hdf5File& file, const FieldBases& fields) {
  const std::size_t n = extent(fields.fluid.points.rows()), k = extent(fields.solids.points.rows());
  file.create_group("fields");
  file.write_attribute("fields", "format_version", field_bases_version);
  write_mesh(file, "fields/fluid", fields.fluid);
  write_mesh(file, "fields/solids", fields.solids);
  write_modes(file, "fields/fluid/velocity", fields.velocity, {n, 2, extent(fields.velocity.cols())}, "1");
  write_modes(file, "fields/fluid/pressure", fields.pressure, {n, extent(fields.pressure.cols())},
              "dyn/cm^2");
  write_modes(file, "fields/solids/displacement", fields.displacement,
              {k, 2, extent(fields.displacement.cols())}, "1");
  write_modes(file, "fields/solids/holder", fields.holder, {k, 2}, "1");
}

} // namespace

void save_model(const Model& model, const std::string& name) {
  check_meaning(model, name);
  auto file = Hdf5File::create(name);
  write_model(file, model);
  file.commit();
}

void save_model(const Model& model, const std::string& name, const FieldBases& fields) {
  check_meaning(model, name);
  check_fields(model, fields, name);
  auto file = Hdf5File::create(name);
  write_model(file, model);
  write_fields(file, fields);
  file.commit();
}

Model load_model(const std::string& name) {
  const auto file = Hdf5File::open_read(name);
  Model model;
  model.sealed = version_of(file) != unsealed_version;
  auto& o = model.operators;
  o.velocity_modes = read_count(file, "operators", "velocity_modes", 1);
  o.supremizer_modes = read_count(file, "operators", "supremizer_modes", 0);
  o.pressure_modes = read_count(file, "operators", "pressure_modes", 0);
  o.displacement_modes = read_count(file, "operators", "displacement_modes", 0);
  if (o.supremizer_modes > o.velocity_modes)
    throw InputError("more supremizers than velocity modes", std::to_string(o.supremizer_modes),
                     "at most " + std::to_string(o.velocity_modes), name);
  visit_operators(Reader(file), o, read_count(file, "operators", "probes", 0));
  model.steps_per_period = file.read<int>("steps_per_period", {}).front();
  for (const auto& side : box_sides) {
    const auto range = file.read<double>(std::string("training_box/") + side.name, {2});
    model.box.*side.low = range[0];
    model.box.*side.high = range[1];
  }
  model.references = read_references(file);
  model.error_safety = file.read<double>("error_estimate/safety", {}).front();
  model.error_floor_l_per_min = file.read<double>("error_estimate/floor", {}).front();
  model.provenance = read_provenance(file);
  check_meaning(model, name);
  return model;
}

} // namespace undula::rom
