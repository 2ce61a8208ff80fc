#include "rom/base/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "rom/base/error.hpp"

namespace undula {

void replace_text_file(const std::filesystem::path& file, std::string_view text) {
  auto temporary = file;
  temporary += "." + std::to_string(::getpid()) + ".partial";
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0)
    throw InputError("cannot create file", std::strerror(errno), "a path in an existing, writable folder",
                     file.string());
  bool written = true;
  while (written && !text.empty()) {
    const auto count = ::write(descriptor, text.data(), text.size());
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    written = count > 0 || (count < 0 && errno == EINTR);
  }
  written = written && ::fsync(descriptor) == 0;
  written = ::close(descriptor) == 0 && written;
  written = written && ::rename(temporary.c_str(), file.c_str()) == 0;
  if (written) return;
  const std::string reason = std::strerror(errno);
  ::unlink(temporary.c_str());
  throw NumericsError("cannot write file: " + reason, file.string(), "free space on the disk");
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

} // namespace undula
