// Pictures by gnuplot. Script and data stay beside the picture, so that users can restyle it:
// `gnuplot picture.gp` draws picture.png again.
#pragma once

#include <filesystem>
#include <string>

namespace undula::apps {

/// Text in single quotes as gnuplot reads it, on one line: control characters become spaces.
std::string gnuplot_string(const std::string& text);

/// Throws InputError for a picture whose name does not end in .png or has control characters, or whose folder
/// does not exist.
void check_picture_name(const std::filesystem::path& picture);

/// Writes NAME.dat and NAME.gp beside `picture` (NAME.png) and runs gnuplot on them. `commands` may refer to
/// the data file by the variable `data`; terminal and output are set before them. The picture appears whole
/// or not at all. Returns false, after a warning in the log, when gnuplot is missing or fails; throws
/// InputError when the folder is not writable, or for a name that check_picture_name refuses.
bool draw_picture(const std::filesystem::path& picture, const std::string& data, const std::string& commands);

} // namespace undula::apps
