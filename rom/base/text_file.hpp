// Small text files (tables, XDMF) that are whole at every moment.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace undula {

/// Replaces `file` by `text` in one step: temporary file beside it, flushed to disk, renamed. A kill at any
/// moment leaves either the old or the new content. Throws InputError where the folder is not writable,
/// NumericsError when the disk is full.
void replace_text_file(const std::filesystem::path& file, std::string_view text);

/// A text file that grows at its end. Every call of append() hands its text to the operating system, so that
/// a kill loses nothing; what sync() has seen outlives a crash of the machine as well. Throws InputError
/// where the file cannot be opened, NumericsError when the disk is full.
class AppendedFile {
public:
  explicit AppendedFile(std::filesystem::path file);
  AppendedFile(AppendedFile&& other) noexcept;
  AppendedFile& operator=(AppendedFile&&) = delete;
  ~AppendedFile();

  void append(std::string_view text);
  void sync();

private:
  [[noreturn]] void fail() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// The whole content. Throws InputError if the file cannot be read.
std::string read_text_file(const std::filesystem::path& file);

/// Shortest decimal notation that reads back to exactly `value`.
std::string exact_number(double value);

/// For people, six digits: "0.5", "100", "1e+14".
std::string plain_number(double value);

} // namespace undula
