// What an HDF5 file says it is: its kind, and the version of the format of that kind (docs/data.md).
#pragma once

#include <string>

#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"

namespace undula {

/// A kind of file and the versions of its format. A change that a reader of the version before could not
/// follow, or would misread, is a new version.
struct FileFormat {
  const char* kind;     ///< "undula checkpoint"
  const char* noun;     ///< in messages: "a checkpoint"
  int version;          ///< that is written
  int oldest = version; ///< that is still read
};

/// A whole file, but of a later version: not damaged. Who passes over damaged files, or replaces them, stops
/// here.
class LaterFormatError : public InputError {
  using InputError::InputError;
};

/// The kind that a file says it is of; "another program's" where it says none.
std::string kind_of(const Hdf5File& file);

/// "undula checkpoint 2": kind and version as one attribute, `format` ...
std::string format_text(const FileFormat& format);
/// ... or as two, `kind` and `format_version` (models).
void write_format_version(Hdf5File& file, const FileFormat& format);

/// The version of a file of this kind, however it is written. Throws InputError for another kind and for a
/// version that is read no longer, LaterFormatError for a later one.
int checked_version(const Hdf5File& file, const FileFormat& format);

} // namespace undula
