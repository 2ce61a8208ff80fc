#include "fom/io/scene_stamp.hpp"

#include <cstdio>

namespace undula {

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3u;
  }
  return hash;
}

std::string hexadecimal(std::uint64_t value) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
  return digits;
}

SceneStamp stamp_scene(std::string text) {
  auto hash = hexadecimal(fnv1a(text));
  return {std::move(hash), std::move(text)};
}

} // namespace undula
