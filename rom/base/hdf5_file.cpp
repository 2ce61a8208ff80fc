#include "rom/base/hdf5_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <concepts>
#include <functional>
#include <numeric>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_handle.hpp"

namespace undula {
namespace {

using hdf5::error_text;
using hdf5::Handle;
using hdf5::QuietErrors;

static_assert(std::same_as<hid_t, std::int64_t>, "Hdf5File stores hid_t as std::int64_t");

template <class T>
hid_t memory_type() {
  if constexpr (std::same_as<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::same_as<T, int>) return H5T_NATIVE_INT;
  if constexpr (std::same_as<T, std::int64_t>) return H5T_NATIVE_INT64;
}

// Type in the file: fixed byte order, so that files travel.
template <class T>
hid_t stored_type() {
  if constexpr (std::same_as<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::same_as<T, int>) return H5T_STD_I32LE;
  if constexpr (std::same_as<T, std::int64_t>) return H5T_STD_I64LE;
}

std::string shape_text(const Hdf5File::Shape& shape) {
  if (shape.empty()) return "scalar";
  std::string text;
  for (const auto n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
  return text;
}

std::string class_text(hid_t type) {
  const auto bits = std::to_string(8 * H5Tget_size(type)) + "-bit ";
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return bits + "real";
    case H5T_INTEGER:
      return bits + "integer";
    case H5T_STRING:
      return "text";
    default:
      return "another type";
  }
}

[[noreturn]] void fail_write(const std::filesystem::path& file, const std::string& name) {
  throw NumericsError("cannot write '" + name + "': " + error_text(), file.string(),
                      "free space on the disk; a name can be written only once");
}

// Reading any of the classes below as T must lose nothing.
template <class T>
void check_type(hid_t type, const std::filesystem::path& file, const std::string& name) {
  const auto wanted = std::same_as<T, double> ? H5T_FLOAT : H5T_INTEGER;
  if (H5Tget_class(type) == wanted && H5Tget_size(type) <= sizeof(T)) return;
  throw InputError("'" + name + "' has the wrong type", class_text(type), class_text(stored_type<T>()),
                   file.string());
}

Handle open_dataset(hid_t id, const std::filesystem::path& file, const std::string& name) {
  Handle dataset(H5Dopen2(id, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid())
    throw InputError("no dataset '" + name + "'", error_text(), "a file that holds it", file.string());
  return dataset;
}

Hdf5File::Shape shape_of(hid_t space) {
  const int rank = std::max(0, H5Sget_simple_extent_ndims(space));
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

Handle make_space(const Hdf5File::Shape& shape) {
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  return {shape.empty() ? H5Screate(H5S_SCALAR)
                        : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr),
          H5Sclose};
}

Handle make_text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(length, 1)); // HDF5 has no strings of size zero
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

Handle make_dataset(hid_t id, const std::string& name, hid_t type, hid_t space) {
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  return {H5Dcreate2(id, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose};
}

// Text of fixed or variable length; `fetch` reads the stored value into memory of the given type.
std::string fetch_text(hid_t type, hid_t space, const std::filesystem::path& file, const std::string& name,
                       const std::function<herr_t(hid_t, void*)>& fetch) {
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
    throw InputError("'" + name + "' has the wrong type", class_text(type), "one text", file.string());
  const auto check = [&](herr_t status) {
    if (status < 0)
      throw InputError("cannot read '" + name + "'", error_text(), "an undamaged file", file.string());
  };
  if (H5Tis_variable_str(type) > 0) {
    char* raw = nullptr;
    check(fetch(type, &raw));
    std::string text = raw ? raw : "";
    H5free_memory(raw);
    return text;
  }
  std::string text(H5Tget_size(type), '\0');
  check(fetch(type, text.data()));
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

template <class T>
void write_numbers(hid_t id, const std::filesystem::path& file, const std::string& name,
                   std::span<const T> values, const Hdf5File::Shape& shape) {
  const auto count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  if (count != values.size())
    throw InputError("cannot write '" + name + "'", std::to_string(values.size()) + " values",
                     "as many as the shape " + shape_text(shape) + " holds", file.string());
  const QuietErrors quiet;
  const Handle space = make_space(shape);
  const Handle dataset = make_dataset(id, name, stored_type<T>(), space);
  if (!dataset.valid()) fail_write(file, name);
  if (!values.empty() &&
      H5Dwrite(dataset, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail_write(file, name);
}

// Attribute of a type with a fixed size.
void put_attribute(hid_t id, const std::filesystem::path& file, const std::string& object,
                   const std::string& name, hid_t stored, hid_t memory, const void* value) {
  const QuietErrors quiet;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate_by_name(id, object.c_str(), name.c_str(), stored, space, H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, memory, value) < 0) fail_write(file, object + "@" + name);
}

} // namespace

Hdf5File::Hdf5File(std::int64_t id, std::filesystem::path target, std::filesystem::path temporary)
    : id_(id), target_(std::move(target)), temporary_(std::move(temporary)) {}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  if (this == &other) return *this;
  close();
  id_ = std::exchange(other.id_, -1);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  return *this;
}

Hdf5File::~Hdf5File() { close(); }

void Hdf5File::close() noexcept {
  if (id_ >= 0) {
    const QuietErrors quiet;
    H5Fclose(std::exchange(id_, -1));
  }
  if (temporary_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  temporary_.clear();
}

Hdf5File Hdf5File::open_read(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure))
    throw InputError("cannot open file",
                     std::filesystem::exists(file, failure) ? "not a regular file" : "no such file",
                     "an existing HDF5 file", file.string());
  const QuietErrors quiet;
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) {
    const auto size = std::filesystem::file_size(file, failure);
    if (const std::string reason = error_text(); reason.find("unable to lock") != std::string::npos)
      throw InputError("the file is open in another program that may write to it", reason,
                       "a file that no other program holds open for writing", file.string());
    throw InputError("not a readable HDF5 file", std::to_string(size) + " bytes: " + error_text(),
                     "a complete HDF5 file (this one is truncated, foreign or not readable)", file.string());
  }
  return {id, file, {}};
}

Hdf5File Hdf5File::create(const std::filesystem::path& target) {
  static std::atomic<int> counter = 0;
  auto temporary = target;
  temporary += "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".partial";
  const QuietErrors quiet;
  const hid_t id = H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (id < 0)
    throw InputError("cannot create file", error_text(), "a path in an existing, writable folder",
                     target.string());
  return {id, target, std::move(temporary)};
}

void Hdf5File::commit() {
  const auto fail = [this](const std::string& what) {
    close();
    throw NumericsError("cannot complete file: " + what, target_.string(),
                        "free space on the disk, check permissions");
  };
  if (id_ < 0 || temporary_.empty()) fail("it is not open for writing");
  {
    const QuietErrors quiet;
    if (H5Fclose(std::exchange(id_, -1)) < 0) fail(error_text());
  }
  // Data first, then the name: a crash in between leaves the old target.
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool on_disk = descriptor >= 0 && ::fsync(descriptor) == 0;
  if (descriptor >= 0) ::close(descriptor);
  if (!on_disk) fail("fsync failed");
  std::error_code failure;
  std::filesystem::rename(temporary_, target_, failure);
  if (failure) fail(failure.message());
  temporary_.clear();
  const auto folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
  const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;
  ::fsync(directory); // makes the rename itself durable; some file systems refuse, which harms nothing
  ::close(directory);
}

void Hdf5File::write(const std::string& name, std::span<const double> values, const Shape& shape,
                     std::string_view unit) {
  write_numbers(id_, target_, name, values, shape);
  if (!unit.empty()) write_attribute(name, "unit", unit);
}

void Hdf5File::write(const std::string& name, std::span<const int> values, const Shape& shape,
                     std::string_view unit) {
  write_numbers(id_, target_, name, values, shape);
  if (!unit.empty()) write_attribute(name, "unit", unit);
}

void Hdf5File::write(const std::string& name, std::span<const std::int64_t> values, const Shape& shape,
                     std::string_view unit) {
  write_numbers(id_, target_, name, values, shape);
  if (!unit.empty()) write_attribute(name, "unit", unit);
}

void Hdf5File::write_text(const std::string& name, std::string_view text) {
  const QuietErrors quiet;
  const Handle type = make_text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle dataset = make_dataset(id_, name, type, space);
  const char nothing = '\0';
  if (!dataset.valid() ||
      H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.empty() ? &nothing : text.data()) < 0)
    fail_write(target_, name);
}

void Hdf5File::create_group(const std::string& name) {
  const QuietErrors quiet;
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Handle group(H5Gcreate2(id_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail_write(target_, name);
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, std::string_view value) {
  const Handle type = make_text_type(value.size());
  const char nothing = '\0';
  put_attribute(id_, target_, object, name, type, type, value.empty() ? &nothing : value.data());
}

#define UNDULA_DEFINE_WRITE_ATTRIBUTE(T)                                                        \
  void Hdf5File::write_attribute(const std::string& object, const std::string& name, T value) { \
    put_attribute(id_, target_, object, name, stored_type<T>(), memory_type<T>(), &value);      \
  }
UNDULA_DEFINE_WRITE_ATTRIBUTE(double)
UNDULA_DEFINE_WRITE_ATTRIBUTE(int)
UNDULA_DEFINE_WRITE_ATTRIBUTE(std::int64_t)

bool Hdf5File::exists(const std::string& name) const {
  const QuietErrors quiet;
  // H5Lexists requires every group on the way to exist, so ask for one after the other.
  for (auto end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1))
    if (H5Lexists(id_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return name == "/" || H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  const QuietErrors quiet;
  return exists(object) && H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::children(const std::string& group) const {
  const QuietErrors quiet;
  const Handle opened(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!opened.valid())
    throw InputError("no group '" + group + "'", error_text(), "a file that holds it", path().string());
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    throw InputError("cannot list group '" + group + "'", error_text(), "an undamaged file", path().string());
  return names;
}

Hdf5File::Shape Hdf5File::extents(const std::string& name) const {
  const QuietErrors quiet;
  const Handle dataset = open_dataset(id_, target_, name);
  return shape_of(Handle(H5Dget_space(dataset), H5Sclose));
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& name) const {
  const QuietErrors quiet;
  const Handle dataset = open_dataset(id_, target_, name);
  check_type<T>(Handle(H5Dget_type(dataset), H5Tclose), target_, name);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const auto count = std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space));
  std::vector<T> values(static_cast<std::size_t>(count));
  if (!values.empty() && H5Dread(dataset, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw InputError("cannot read '" + name + "'", error_text(), "an undamaged file", target_.string());
  return values;
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& name, const Shape& shape) const {
  const auto seen = extents(name);
  if (seen != shape)
    throw InputError("'" + name + "' has the wrong shape", shape_text(seen), shape_text(shape),
                     target_.string());
  return read<T>(name);
}

std::string Hdf5File::read_text(const std::string& name) const {
  const QuietErrors quiet;
  const Handle dataset = open_dataset(id_, target_, name);
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  return fetch_text(type, space, target_, name, [&](hid_t memory, void* value) {
    return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, value);
  });
}

template <class T>
T Hdf5File::read_attribute(const std::string& object, const std::string& name) const {
  const QuietErrors quiet;
  const auto full_name = object + "@" + name;
  const Handle attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid())
    throw InputError("no attribute '" + full_name + "'", error_text(), "a file that holds it",
                     target_.string());
  const Handle type(H5Aget_type(attribute), H5Tclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  if constexpr (std::same_as<T, std::string>) {
    return fetch_text(type, space, target_, full_name,
                      [&](hid_t memory, void* value) { return H5Aread(attribute, memory, value); });
  } else {
    check_type<T>(type, target_, full_name);
    T value = 0;
    if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, memory_type<T>(), &value) < 0)
      throw InputError("cannot read attribute '" + full_name + "'", error_text(), "one number",
                       target_.string());
    return value;
  }
}

std::string Hdf5File::unit(const std::string& name) const {
  return has_attribute(name, "unit") ? read_attribute<std::string>(name, "unit") : std::string();
}

#define UNDULA_INSTANTIATE_READ(T)                                                   \
  template std::vector<T> Hdf5File::read<T>(const std::string&) const;               \
  template std::vector<T> Hdf5File::read<T>(const std::string&, const Shape&) const; \
  template T Hdf5File::read_attribute<T>(const std::string&, const std::string&) const;
UNDULA_INSTANTIATE_READ(double)
UNDULA_INSTANTIATE_READ(int)
UNDULA_INSTANTIATE_READ(std::int64_t)
template std::string Hdf5File::read_attribute<std::string>(const std::string&, const std::string&) const;

} // namespace undula
