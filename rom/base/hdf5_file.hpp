// A small owner of one HDF5 file: typed datasets and attributes in, typed errors out. For serial use (one
// rank); it needs no MPI-IO and also works where MPI is not initialised.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rom/base/replaced_file.hpp"

namespace undula {

/// One open HDF5 file. Names are paths inside it ("group/sub/field"); missing groups are created on writing.
/// Arrays are row-major; the shape {} is a scalar.
///
/// Files are checked twice: arrays carry HDF5's own checksum (Fletcher32), which every HDF5 program compares,
/// and the whole file carries a seal (seal.hpp) in its user block, which open_read() compares before HDF5
/// sees a byte.
///
/// Errors: InputError for a file that cannot be opened (missing, damaged, foreign) or does not hold what is
/// asked for (name, type, shape); NumericsError where writing fails (disk full, say).
class Hdf5File {
public:
  using Shape = std::vector<std::size_t>;

  /// Opens an existing file read-only. A file whose seal is broken is refused; one without a seal is opened,
  /// see sealed().
  static Hdf5File open_read(const std::filesystem::path& file);

  /// The same, and a file without a seal is refused before HDF5 sees it.
  static Hdf5File open_sealed(const std::filesystem::path& file);

  /// The same, without a look at the seal: for files of which only a little is read.
  static Hdf5File open_unchecked(const std::filesystem::path& file);

  /// Starts a new file in memory, and under a temporary name beside `target`. Only commit() puts it in the
  /// target's place (ReplacedFile); a file destroyed without commit leaves the target as it was.
  static Hdf5File create(const std::filesystem::path& target);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  /// Seals a created file, brings it to the disk and renames it to its target. Nothing may be written
  /// afterwards.
  void commit();

  /// The same without waiting for the disk, see ReplacedFile.
  void commit_unsynced();

  /// Whether the file was opened with a look at its seal, and has one.
  bool sealed() const { return sealed_; }

  const std::filesystem::path& path() const { return target_; }

  /// Writes a new dataset. `shape` defaults to one dimension; the product of its entries must be
  /// values.size(). `unit` (for example "cm/s") is stored as the attribute of that name unless empty.
  void write(const std::string& name, std::span<const double> values, const Shape& shape,
             std::string_view unit = "");
  void write(const std::string& name, std::span<const int> values, const Shape& shape,
             std::string_view unit = "");
  void write(const std::string& name, std::span<const std::int64_t> values, const Shape& shape,
             std::string_view unit = "");
  void write(const std::string& name, std::span<const double> values) {
    write(name, values, {values.size()});
  }
  void write(const std::string& name, std::span<const int> values) { write(name, values, {values.size()}); }
  void write(const std::string& name, std::span<const std::int64_t> values) {
    write(name, values, {values.size()});
  }

  /// Writes a UTF-8 text of any length (attributes are limited to 64 kB) as a scalar dataset.
  void write_text(const std::string& name, std::string_view text);

  void create_group(const std::string& name);

  /// Attributes of a dataset or group ("/" is the file itself); an existing one is an error.
  void write_attribute(const std::string& object, const std::string& name, std::string_view value);
  void write_attribute(const std::string& object, const std::string& name, double value);
  void write_attribute(const std::string& object, const std::string& name, int value);
  void write_attribute(const std::string& object, const std::string& name, std::int64_t value);

  /// Whether a dataset or group of that name is in the file.
  bool exists(const std::string& name) const;
  bool has_attribute(const std::string& object, const std::string& name) const;

  /// What a name stands for; `other`: what this class does not read.
  enum class Content { group, real, integer, text, other };
  Content content(const std::string& name) const;

  /// Names (not paths) of the datasets and groups directly in `group`, in alphabetical order.
  std::vector<std::string> children(const std::string& group) const;

  /// Extents of a dataset, {} for a scalar.
  Shape extents(const std::string& name) const;

  /// All values of a dataset, row-major. T is double, int or std::int64_t; a dataset of another class (or of
  /// wider numbers than T) is an InputError, so nothing is rounded or clipped on the way in; so is one that
  /// claims more values than the file can hold.
  template <class T>
  std::vector<T> read(const std::string& name) const;

  /// The same, and an InputError unless the dataset has exactly this shape.
  template <class T>
  std::vector<T> read(const std::string& name, const Shape& shape) const;

  std::string read_text(const std::string& name) const;

  /// T is std::string, double, int or std::int64_t.
  template <class T>
  T read_attribute(const std::string& object, const std::string& name) const;

  /// The attribute `unit` of a dataset, empty if there is none.
  std::string unit(const std::string& name) const;

private:
  Hdf5File(std::int64_t id, std::filesystem::path target);
  ReplacedFile finished();
  void close() noexcept;

  std::int64_t id_ = -1;                // hid_t of the file, -1 when closed
  std::filesystem::path target_;        // name the user knows
  std::optional<ReplacedFile> written_; // none when reading
  bool sealed_ = false;
};

} // namespace undula
