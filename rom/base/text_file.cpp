#include "rom/base/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/replaced_file.hpp"

namespace undula {

void replace_text_file(const std::filesystem::path& file, std::string_view text) {
  ReplacedFile replaced(file);
  replaced.write(text);
  replaced.commit();
}

AppendedFile::AppendedFile(std::filesystem::path file)
    : file_(std::move(file)), descriptor_(::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw InputError("cannot append to file", std::strerror(errno), "a writable file", file_.string());
}

AppendedFile::AppendedFile(AppendedFile&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

AppendedFile::~AppendedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendedFile::append(std::string_view text) {
  while (!text.empty()) {
    const auto count = ::write(descriptor_, text.data(), text.size());
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) fail();
  }
}

void AppendedFile::sync() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(); // EINVAL: pipes and the like know no disk
}

void AppendedFile::fail() const {
  throw NumericsError("cannot append to file: " + std::string(std::strerror(errno)), file_.string(),
                      "free space on the disk, then start again (`solve` with --restart)");
}

std::string read_text_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in)
    throw InputError("cannot read file", std::filesystem::exists(file) ? "not readable" : "no such file",
                     "an existing text file", file.string());
  return text.str();
}

std::string exact_number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string plain_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

} // namespace undula
