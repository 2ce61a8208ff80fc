#include "rom/base/file_format.hpp"

#include <charconv>
#include <optional>
#include <utility>

namespace undula {
namespace {

struct Stated {
  std::string kind;
  int version = 0;
};

/// "undula checkpoint 2" -> "undula checkpoint", 2; nothing for other texts.
std::optional<Stated> parsed(const std::string& text) {
  const auto space = text.rfind(' ');
  if (space == std::string::npos) return std::nullopt;
  Stated stated{text.substr(0, space), 0};
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data() + space + 1, end, stated.version);
  if (number.ec != std::errc() || number.ptr != end) return std::nullopt;
  return stated;
}

/// Kind and version as they stand in the file; no kind where it states none.
Stated stated_by(const Hdf5File& file) {
  if (file.has_attribute("/", "kind"))
    return {file.read_attribute<std::string>("/", "kind"),
            file.has_attribute("/", "format_version") ? file.read_attribute<int>("/", "format_version") : 0};
  if (file.has_attribute("/", "format")) {
    auto text = file.read_attribute<std::string>("/", "format");
    return parsed(text).value_or(Stated{std::move(text), 0});
  }
  return {};
}

std::string read_versions(const FileFormat& format) {
  std::string text = "format ";
  if (format.oldest < format.version) text += std::to_string(format.oldest) + " to ";
  return text + std::to_string(format.version);
}

} // namespace

std::string kind_of(const Hdf5File& file) {
  auto kind = stated_by(file).kind;
  return kind.empty() ? "another program's" : kind;
}

std::string format_text(const FileFormat& format) {
  return std::string(format.kind) + " " + std::to_string(format.version);
}

void write_format_version(Hdf5File& file, const FileFormat& format) {
  file.write_attribute("/", "kind", std::string_view(format.kind));
  file.write_attribute("/", "format_version", format.version);
}

int checked_version(const Hdf5File& file, const FileFormat& format) {
  if (const auto seen = kind_of(file); seen != format.kind)
    throw InputError(std::string("not ") + format.noun, "a file of kind '" + seen + "'",
                     "kind '" + std::string(format.kind) + "'", file.path().string());
  const int version = stated_by(file).version;
  const std::string seen = std::string(format.kind) + ", format " + std::to_string(version);
  if (version > format.version)
    throw LaterFormatError("the file was written by a later version of Undula", seen,
                           read_versions(format) + "; the later version reads this file",
                           file.path().string());
  if (version < format.oldest)
    throw InputError("the file was written by an older version of Undula, and is read no longer", seen,
                     read_versions(format) + "; compute it again", file.path().string());
  return version;
}

} // namespace undula
