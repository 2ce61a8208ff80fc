#include "fom/output/field_writer.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <set>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/replaced_file.hpp"

namespace undula::fom {
namespace {

constexpr FileFormat file_format{"undula fields", "a file of fields", 1};
constexpr std::chrono::seconds index_interval{1};

void check_name(const std::string& name, const std::string& where) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return;
  throw InputError("bad name of a field or series", "\"" + name + "\"", "letters, digits and _", where);
}

void write_header(Hdf5File& file, const std::map<std::string, std::string>& provenance) {
  file.write_attribute("/", "format", format_text(file_format));
  file.create_group("provenance");
  for (const auto& [key, text] : provenance) file.write_text("provenance/" + key, text);
}

template <int dim>
void check_cells(const FieldMesh<dim>& mesh, const std::string& where) {
  const auto count = static_cast<int>(mesh.points.size());
  for (const auto& cell : mesh.cells)
    for (const int point : cell)
      if (point < 0 || point >= count)
        throw InputError("a cell to draw names a point that does not exist", std::to_string(point),
                         "0 to " + std::to_string(count - 1), where);
}

/// [n][dim] -> [n][3]
template <int dim>
std::vector<double> three_components(std::span<const double> values) {
  const auto count = values.size() / dim;
  std::vector<double> result(3 * count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < dim; ++k) result[3 * i + k] = values[dim * i + k];
  return result;
}

template <int dim>
void write_points_and_cells(Hdf5File& file, const FieldMesh<dim>& mesh) {
  std::vector<double> points;
  for (const auto& point : mesh.points) points.insert(points.end(), point.data(), point.data() + dim);
  std::vector<int> cells;
  for (const auto& cell : mesh.cells) cells.insert(cells.end(), cell.begin(), cell.end());
  file.write("points", std::span<const double>(three_components<dim>(points)), {mesh.points.size(), 3}, "cm");
  file.write("cells", std::span<const int>(cells), {mesh.cells.size(), dim + 1});
}

} // namespace

template <int dim>
FieldWriter<dim>::FieldWriter(std::filesystem::path folder, const std::string& name,
                              const FieldMesh<dim>& mesh,
                              const std::map<std::string, std::string>& provenance)
    : folder_(std::move(folder)),
      provenance_(provenance),
      series_{name, name + "_mesh.h5", dim, mesh.points.size(), mesh.cells.size(), {}} {
  check_name(name, folder_.string());
  check_cells(mesh, "field series " + name);
  std::filesystem::create_directories(folder_);
}

template <int dim>
FieldWriter<dim> FieldWriter<dim>::start(const std::filesystem::path& folder, const std::string& name,
                                         const FieldMesh<dim>& mesh,
                                         const std::map<std::string, std::string>& provenance) {
  FieldWriter writer(folder, name, mesh, provenance);
  // The index first: at no moment does it name files that are gone.
  writer.write_index();
  for (const auto& [step, file] : writer.step_files()) std::filesystem::remove(file);
  writer.write_mesh(mesh);
  return writer;
}

template <int dim>
FieldWriter<dim> FieldWriter<dim>::go_on(const std::filesystem::path& folder, const std::string& name,
                                         const FieldMesh<dim>& mesh,
                                         const std::map<std::string, std::string>& provenance,
                                         int last_step) {
  FieldWriter writer(folder, name, mesh, provenance);
  std::vector<std::filesystem::path> dropped;
  for (const auto& [step, file] : writer.step_files()) {
    if (step > last_step)
      dropped.push_back(file);
    else
      writer.series_.steps.push_back(writer.read_step(file));
  }
  writer.write_mesh(mesh);
  writer.write_index();
  for (const auto& file : dropped) std::filesystem::remove(file);
  return writer;
}

template <int dim>
void FieldWriter<dim>::write(int step, double time, std::span<const NodalField> fields,
                             const FieldMesh<dim>* mesh) {
  const auto where = "field series " + series_.name + ", step " + std::to_string(step);
  const int last = series_.steps.empty() ? -1 : series_.steps.back().step;
  if (step <= last)
    throw InputError("steps of a field series must rise", std::to_string(step),
                     "later than " + std::to_string(last), where);
  XdmfStep entry{step, time, series_.name + "_" + std::to_string(step) + ".h5", {}};
  if (mesh != nullptr) {
    check_cells(*mesh, where);
    entry.points = mesh->points.size();
    entry.cells = mesh->cells.size();
  }
  const std::size_t points = mesh != nullptr ? entry.points : series_.points;
  std::set<std::string> names;
  for (const auto& field : fields) {
    check_name(field.name, where);
    const bool vector = field.components == dim;
    if ((field.components != 1 && !vector) ||
        field.values.size() != points * static_cast<std::size_t>(field.components) ||
        !names.insert(field.name).second)
      throw InputError("field \"" + field.name + "\" does not fit the mesh",
                       std::to_string(field.values.size()) + " values of " +
                           std::to_string(field.components) + " components",
                       "a name used once, 1 or " + std::to_string(dim) + " components on " +
                           std::to_string(points) + " points",
                       where);
    entry.fields.push_back({field.name, field.unit, vector});
  }
  auto file = Hdf5File::create(folder_ / entry.file);
  write_header(file, provenance_);
  file.write_attribute("/", "step", step);
  file.write_attribute("/", "time", time);
  file.create_group("fields");
  for (const auto& field : fields) {
    const auto path = "fields/" + field.name;
    if (field.components == 1)
      file.write(path, std::span(field.values), {points}, field.unit);
    else
      file.write(path, std::span<const double>(three_components<dim>(field.values)), {points, 3}, field.unit);
  }
  if (mesh != nullptr) write_points_and_cells(file, *mesh);
  file.commit_unsynced();
  unsynced_.push_back(folder_ / entry.file);
  series_.steps.push_back(std::move(entry));
  // The index names every step so far: writing it each time would cost the square of their number.
  if (std::chrono::steady_clock::now() - indexed_at_ >= index_interval) write_index();
}

template <int dim>
void FieldWriter<dim>::sync() {
  if (indexed_steps_ != series_.steps.size()) write_index();
  sync_files(folder_, unsynced_);
  unsynced_.clear();
}

template <int dim>
std::map<int, std::filesystem::path> FieldWriter<dim>::step_files() const {
  std::map<int, std::filesystem::path> files;
  const auto prefix = series_.name + "_";
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const auto name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(".h5")) continue;
    int step = -1;
    const char* end = name.data() + name.size() - 3;
    const auto parsed = std::from_chars(name.data() + prefix.size(), end, step);
    if (parsed.ec == std::errc() && parsed.ptr == end && step >= 0) files[step] = entry.path();
  }
  return files;
}

template <int dim>
XdmfStep FieldWriter<dim>::read_step(const std::filesystem::path& path) const {
  const auto file = Hdf5File::open_unchecked(path); // fields may be large, and no state is read from them
  checked_version(file, file_format);
  XdmfStep entry{file.read_attribute<int>("/", "step"),
                 file.read_attribute<double>("/", "time"),
                 path.filename().string(),
                 {}};
  if (file.exists("points")) {
    entry.points = file.extents("points")[0];
    entry.cells = file.extents("cells")[0];
  }
  const std::size_t points = entry.points > 0 ? entry.points : series_.points;
  for (const auto& name : file.children("fields")) {
    const auto extents = file.extents("fields/" + name);
    if (extents.empty() || extents[0] != points)
      throw InputError("the field series was written on another mesh",
                       std::to_string(extents.empty() ? 1 : extents[0]) + " points",
                       std::to_string(points) + " points", path.string());
    entry.fields.push_back({name, file.unit("fields/" + name), extents.size() == 2});
  }
  return entry;
}

template <int dim>
void FieldWriter<dim>::write_mesh(const FieldMesh<dim>& mesh) const {
  auto file = Hdf5File::create(folder_ / series_.mesh_file);
  write_header(file, provenance_);
  write_points_and_cells(file, mesh);
  file.commit();
}

template <int dim>
void FieldWriter<dim>::write_index() {
  const auto name = folder_ / (series_.name + ".xdmf");
  ReplacedFile index(name);
  index.write(xdmf_text(series_));
  index.commit_unsynced();
  unsynced_.push_back(name);
  indexed_at_ = std::chrono::steady_clock::now();
  indexed_steps_ = series_.steps.size();
}

template class FieldWriter<2>;
template class FieldWriter<3>;

} // namespace undula::fom
