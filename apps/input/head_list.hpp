// Lists of numbers as typed on the command line: "40:62:2", "40,45.5,50", or both mixed.
#pragma once

#include <string>
#include <vector>

namespace undula::apps {

/// What a list holds, for its messages.
struct NumberList {
  const char *noun, *unit, *example, *option;
};

/// Numbers in the order given. A range low:high:step includes `high` when it falls on a step (to 1e-9
/// of a step); a comma joins values and ranges. Throws InputError for anything else, for a step that does not
/// lead from low to high, and for more than 10,000 numbers.
std::vector<double> parse_numbers(const std::string& text, const NumberList& list);

/// Heads in mmHg.
std::vector<double> parse_heads(const std::string& text);

/// `count` >= 1 heads from low to high at equal distances; the middle for count = 1.
std::vector<double> even_heads(double low, double high, int count);

} // namespace undula::apps
