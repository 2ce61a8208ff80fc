// scene_to_toml and scene_hash: the resolved scene as text and as a fingerprint.
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
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

std::string position_text(const Position& position, double cgs_per_unit) {
  return "[" + shortest_number(to_surface_unit(position[0], cgs_per_unit)) + ", " +
         shortest_number(to_surface_unit(position[1], cgs_per_unit)) + "]";
}

/// "[a, b, ...]", "" for no entries.
template <typename List, typename Text>
std::string list_text(const List& list, const Text& text_of) {
  std::string text;
  for (const auto& entry : list) {
    text += (text.empty() ? "" : ", ") + text_of(entry);
  }
  return text.empty() ? "" : "[" + text + "]";
}

/// Value of a key in TOML notation; "" for a file, list or expression that is left out.
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
  if (const auto* files = std::get_if<FileListKey>(&key.value)) {
    return list_text(files->field(scene), [](const auto& entry) { return toml_string(entry.string()); });
  }
  if (const auto* expression = std::get_if<ExpressionKey>(&key.value)) {
    return expression->field(scene).empty() ? "" : toml_string(expression->field(scene));
  }
  if (const auto* pair = std::get_if<ExpressionPairKey>(&key.value)) {
    return pair->field(scene)[0].empty() ? "" : list_text(pair->field(scene), toml_string);
  }
  if (const auto* position = std::get_if<PositionKey>(&key.value)) {
    return position_text(position->field(scene), position->cgs_per_unit);
  }
  if (const auto* positions = std::get_if<PositionListKey>(&key.value)) {
    return list_text(positions->field(scene), [&](const Position& position) {
      return position_text(position, positions->cgs_per_unit);
    });
  }
  if (const auto* name = std::get_if<NameKey>(&key.value)) {
    return name->field(scene).empty() ? "" : toml_string(name->field(scene));
  }
  return list_text(std::get<NameListKey>(key.value).field(scene), toml_string);
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
  for (const SceneKey& key : keys_of(scene)) {
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
  for (const SceneKey& key : keys_of(scene)) {
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

} // namespace undula::fom
