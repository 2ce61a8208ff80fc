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

/// The whole content. Throws InputError if the file cannot be read.
std::string read_text_file(const std::filesystem::path& file);

/// Shortest decimal notation that reads back to exactly `value`.
std::string exact_number(double value);

} // namespace undula
