// A key of a scene with a range, as a text: "geometry.rim_gap_scale=0.8:1.2".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace undula::training {

struct KeyRange {
  std::string key;
  double low = 0, high = 0; ///< unit of the key
};

/// Nothing for a text that is not key=low:high with finite numbers. The key may be unknown, the range upside
/// down.
std::optional<KeyRange> read_key_range(std::string_view text);

/// Nothing for a text that is not one finite number.
std::optional<double> read_finite(std::string_view text);

} // namespace undula::training
