// scene_to_toml and scene_hash: the resolved scene as text and as a fingerprint.
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "fom/scene/scene_value.hpp"

namespace undula {
namespace {

/// TOML basic string.
std::string toml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7f) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x", code);
      quoted += escape.data();
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

/// Value of a key in TOML notation; "" for a file or list that is left out.
std::string value_text(const SceneKey& key, Scene& scene) {
  if (const auto* real = std::get_if<RealKey>(&key.value)) {
    return shortest_number(to_surface_unit(real->field(scene), real->cgs_per_unit));
  }
  if (const auto* integer = std::get_if<IntegerKey>(&key.value)) {
    return std::to_string(integer->field(scene));
  }
  if (const auto* choice = std::get_if<ChoiceKey>(&key.value)) {
    for (const auto& [name, enumerator] : choice->available) {
      if (enumerator == choice->get(scene)) {
        return toml_string(name);
      }
    }
  }
  if (const auto* text = std::get_if<TextKey>(&key.value)) {
    return toml_string(text->field(scene));
  }
  if (const auto* file = std::get_if<FileKey>(&key.value)) {
    return file->field(scene).empty() ? "" : toml_string(file->field(scene).string());
  }
  std::string list;
  for (const auto& file : std::get<FileListKey>(key.value).field(scene)) {
    list += (list.empty() ? "" : ", ") + toml_string(file.string());
  }
  return list.empty() ? "" : "[" + list + "]";
}

/// FNV-1a, 64 bit (Fowler, Noll, Vo): fixed by its definition on every machine, unlike std::hash.
class Fingerprint {
public:
  void add(const std::string& bytes) {
    for (const char c : bytes) {
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
  }
  [[nodiscard]] std::string hex() const {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(state_));
    return text.data();
  }

private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

std::string file_content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError("a file named by the scene cannot be read", file.string(), "a readable file",
                     "section [geometry] of the scene");
  }
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

} // namespace

std::string scene_to_toml(const Scene& scene) {
  Scene copy = scene; // the accessors of the table give mutable references
  std::string text;
  std::string section;
  for (const SceneKey& key : scene_table()) {
    const std::string value = value_text(key, copy);
    if (value.empty()) {
      continue;
    }
    if (key.section() != section) {
      section = key.section();
      text += "\n[" + section + "]\n";
    }
    const double tolerance = tolerance_of(scene, key.path);
    text += key.leaf() + " = " +
            (tolerance == 0 ? value
                            : "{ value = " + value + ", tolerance = " + shortest_number(tolerance) + " }") +
            "\n";
  }
  return text;
}

std::string scene_hash(const Scene& scene) {
  Scene copy = scene;
  Fingerprint fingerprint;
  for (const SceneKey& key : scene_table()) {
    if (!key.shapes_state) {
      continue;
    }
    fingerprint.add(key.path + "=");
    // A file counts by its content: a scene may be moved.
    if (const auto* file = std::get_if<FileKey>(&key.value)) {
      fingerprint.add(file->field(copy).empty() ? "" : file_content(file->field(copy)));
    } else if (const auto* list = std::get_if<FileListKey>(&key.value)) {
      for (const auto& entry : list->field(copy)) {
        fingerprint.add(file_content(entry));
      }
    } else {
      fingerprint.add(value_text(key, copy));
    }
    fingerprint.add("\n");
  }
  return fingerprint.hex();
}

} // namespace undula
