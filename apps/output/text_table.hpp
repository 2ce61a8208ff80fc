// Tables for people on stdout.
#pragma once

#include <string>
#include <vector>

namespace undula::apps {

/// Columns aligned to the right (to the left in the first), two blanks apart, one line per row, the header
/// first. Every row has as many cells as the header.
std::string text_table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows);

/// Fixed notation with the given number of decimals.
std::string decimals(double value, int count);

} // namespace undula::apps
