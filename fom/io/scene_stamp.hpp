// What ties a stored result to the scene it came from.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace undula {

/// The resolved text of the scene keys that shape a result, and its hash. Two results may be mixed (restart,
/// campaign) only if their hashes agree.
struct SceneStamp {
  std::string hash; ///< 16 hexadecimal digits
  std::string text;
};

/// FNV-1a, 64 bit (Fowler, Noll, Vo; draft-eastlake-fnv): the same on every machine and compiler. It guards
/// against mistakes, not against forgery.
std::uint64_t fnv1a(std::string_view bytes);

/// 16 lower-case hexadecimal digits.
std::string hexadecimal(std::uint64_t value);

SceneStamp stamp_scene(std::string text);

} // namespace undula
