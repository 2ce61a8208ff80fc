#include "rom/base/hdf5_file.hpp"

#include <algorithm>
#include <atomic>
#include <concepts>
#include <functional>
#include <numeric>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_handle.hpp"
#include "rom/base/seal.hpp"

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
                      "a name that is not yet in the file; more memory");
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

// Checksums need chunks. They are whole rows (slices of the first dimension), about a megabyte each.
void add_checksum(hid_t settings, const Hdf5File::Shape& shape, std::size_t bytes_per_value) {
  constexpr std::size_t aim = 1 << 20;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  const auto row = std::accumulate(chunk.begin() + 1, chunk.end(), bytes_per_value, std::multiplies<>());
  chunk[0] = std::clamp<hsize_t>(aim / row, 1, chunk[0]);
  H5Pset_chunk(settings, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_fletcher32(settings);
}

Handle make_dataset(hid_t id, const std::string& name, hid_t type, hid_t space,
                    const Hdf5File::Shape& shape) {
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Handle settings(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(settings, 0); // the same numbers make the same file
  const bool empty = std::find(shape.begin(), shape.end(), std::size_t{0}) != shape.end();
  if (!shape.empty() && !empty) add_checksum(settings, shape, H5Tget_size(type));
  return {H5Dcreate2(id, name.c_str(), type, space, links, settings, H5P_DEFAULT), H5Dclose};
}

std::size_t file_size(hid_t any_object) {
  const Handle file(H5Iget_file_id(any_object), H5Fclose);
  hsize_t bytes = 0;
  return file.valid() && H5Fget_filesize(file, &bytes) >= 0 ? bytes : 0;
}

// Before memory is asked for: the values have to be in the file, uncompressed as they are.
void check_size(hid_t object, std::size_t count, std::size_t bytes_per_value,
                const std::filesystem::path& file, const std::string& name) {
  const auto size = file_size(object);
  if (count <= size / std::max<std::size_t>(bytes_per_value, 1)) return;
  throw InputError("'" + name + "' claims to be larger than the file",
                   std::to_string(count) + " values of " + std::to_string(bytes_per_value) + " bytes",
                   "an undamaged file; this one has " + std::to_string(size) + " bytes", file.string());
}

// Text of fixed or variable length in `object`; `fetch` reads the stored value into memory of the given type.
std::string fetch_text(hid_t object, hid_t type, hid_t space, const std::filesystem::path& file,
                       const std::string& name, const std::function<herr_t(hid_t, void*)>& fetch) {
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
  check_size(object, H5Tget_size(type), 1, file, name);
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
  const Handle dataset = make_dataset(id, name, stored_type<T>(), space, shape);
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

void require_file(const std::filesystem::path& file) {
  std::error_code failure;
  if (std::filesystem::is_regular_file(file, failure)) return;
  throw InputError("cannot open file",
                   std::filesystem::exists(file, failure) ? "not a regular file" : "no such file",
                   "an existing HDF5 file", file.string());
}

} // namespace

Hdf5File::Hdf5File(std::int64_t id, std::filesystem::path target) : id_(id), target_(std::move(target)) {}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      target_(std::move(other.target_)),
      written_(std::exchange(other.written_, std::nullopt)),
      sealed_(other.sealed_) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  if (this == &other) return *this;
  close();
  id_ = std::exchange(other.id_, -1);
  target_ = std::move(other.target_);
  written_ = std::exchange(other.written_, std::nullopt);
  sealed_ = other.sealed_;
  return *this;
}

Hdf5File::~Hdf5File() { close(); }

void Hdf5File::close() noexcept {
  if (id_ >= 0) {
    const QuietErrors quiet;
    H5Fclose(std::exchange(id_, -1));
  }
  written_.reset();
}

Hdf5File Hdf5File::open_read(const std::filesystem::path& file) {
  require_file(file);
  const bool sealed = check_seal(file) == Seal::intact;
  Hdf5File opened = open_unchecked(file);
  opened.sealed_ = sealed;
  return opened;
}

Hdf5File Hdf5File::open_sealed(const std::filesystem::path& file) {
  require_file(file);
  if (check_seal(file) == Seal::missing)
    throw InputError("not a file of this version of Undula", "no seal in its first bytes",
                     "an undamaged file (this one is truncated, foreign or of an older version)",
                     file.string());
  Hdf5File opened = open_unchecked(file);
  opened.sealed_ = true;
  return opened;
}

Hdf5File Hdf5File::open_unchecked(const std::filesystem::path& file) {
  require_file(file);
  const QuietErrors quiet;
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) {
    std::error_code failure;
    const auto size = std::filesystem::file_size(file, failure);
    if (const std::string reason = error_text(); reason.find("unable to lock") != std::string::npos)
      throw InputError("the file is open in another program that may write to it", reason,
                       "a file that no other program holds open for writing", file.string());
    throw InputError("not a readable HDF5 file", std::to_string(size) + " bytes: " + error_text(),
                     "a complete HDF5 file (this one is truncated, foreign or not readable)", file.string());
  }
  return {id, file};
}

Hdf5File Hdf5File::create(const std::filesystem::path& target) {
  // HDF5 builds the file in memory and never meets a full disk, after which it could not close its files.
  static std::atomic<int> counter = 0;
  constexpr std::size_t growth = 1 << 20;
  ReplacedFile written(target);
  const QuietErrors quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_fapl_core(access, growth, 0);
  H5Pset_userblock(creation, seal_size);
  // HDF5 tells files in memory apart by their names.
  const auto name = "undula file in memory " + std::to_string(counter++);
  const hid_t id = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation, access);
  if (id < 0) throw NumericsError("cannot start a file: " + error_text(), target.string(), "more memory");
  Hdf5File file(id, target);
  file.written_ = std::move(written);
  return file;
}

/// The sealed content, under its temporary name.
ReplacedFile Hdf5File::finished() {
  if (id_ < 0 || !written_)
    throw NumericsError("cannot complete file: it is not open for writing", target_.string(), "a new file");
  std::vector<std::byte> image;
  {
    const QuietErrors quiet;
    const bool flushed = H5Fflush(id_, H5F_SCOPE_LOCAL) >= 0;
    const auto size = flushed ? H5Fget_file_image(id_, nullptr, 0) : -1;
    if (size > 0) image.resize(static_cast<std::size_t>(size));
    if (size <= 0 || H5Fget_file_image(id_, image.data(), image.size()) != size) {
      const auto reason = error_text();
      close();
      throw NumericsError("cannot complete file: " + reason, target_.string(), "more memory");
    }
    H5Fclose(std::exchange(id_, -1));
  }
  // The image begins behind the user block.
  ReplacedFile written = *std::exchange(written_, std::nullopt);
  written.write(seal_of(image));
  written.write(image);
  return written;
}

void Hdf5File::commit() { finished().commit(); }

void Hdf5File::commit_unsynced() { finished().commit_unsynced(); }

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
  const Handle dataset = make_dataset(id_, name, type, space, {});
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

Hdf5File::Content Hdf5File::content(const std::string& name) const {
  const QuietErrors quiet;
  const Handle object(H5Oopen(id_, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object.valid())
    throw InputError("no dataset or group '" + name + "'", error_text(), "a file that holds it",
                     path().string());
  if (H5Iget_type(object) == H5I_GROUP) return Content::group;
  if (H5Iget_type(object) != H5I_DATASET) return Content::other;
  switch (H5Tget_class(Handle(H5Dget_type(object), H5Tclose))) {
    case H5T_FLOAT:
      return Content::real;
    case H5T_INTEGER:
      return Content::integer;
    case H5T_STRING:
      return Content::text;
    default:
      return Content::other;
  }
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
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  check_size(dataset, count, H5Tget_size(Handle(H5Dget_type(dataset), H5Tclose)), target_, name);
  std::vector<T> values(count);
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
  return fetch_text(dataset, type, space, target_, name, [&](hid_t memory, void* value) {
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
    return fetch_text(attribute, type, space, target_, full_name,
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
