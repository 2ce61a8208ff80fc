// The surface form of a scene as one declarative table: key, unit, allowed range, default, help and the field
// of Scene it fills. The parser, the checks, the writer, `--set`, `undula check` and docs/scene.md all read
// it.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fom/scene/scene.hpp"

namespace undula {

/// Interval of allowed numbers in the key's unit.
struct AllowedRange {
  double low = 0;
  double high = 0;
  bool low_open = false;  ///< the lower bound itself is refused
  bool high_open = false; ///< the upper bound itself is refused

  [[nodiscard]] bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

/// A number in a surface unit; stored value = surface value * cgs_per_unit.
struct RealKey {
  double& (*field)(Scene&);
  double cgs_per_unit = 1;
  AllowedRange allowed;
  std::optional<double> fallback; ///< surface unit; none: the key is required
};

struct IntegerKey {
  int& (*field)(Scene&);
  int low = 0;
  int high = 0;
  std::optional<int> fallback;
};

/// One of a few names.
struct ChoiceKey {
  int (*get)(Scene&);
  void (*set)(Scene&, int);
  std::vector<std::pair<std::string, int>> available; ///< name, enumerator
  std::vector<std::string> planned;                   ///< in the design, refused by this version
  std::string fallback;
};

/// Any non-empty text.
struct TextKey {
  std::string& (*field)(Scene&);
};

/// An existing file; empty when the key is left out.
struct FileKey {
  std::filesystem::path& (*field)(Scene&);
};

/// A list of existing files; empty when the key is left out.
struct FileListKey {
  std::vector<std::filesystem::path>& (*field)(Scene&);
};

struct SceneKey {
  std::string path; ///< "section.key_unit", or "key" outside any section
  std::string unit; ///< "" for numbers without a unit, names and files; otherwise also the end of `path`
  std::string help;
  bool shapes_state; ///< false: a checkpoint stays valid when the value changes (labels, lengths, campaigns)
  std::variant<RealKey, IntegerKey, ChoiceKey, TextKey, FileKey, FileListKey> value;

  [[nodiscard]] std::string section() const; ///< "" outside any section
  [[nodiscard]] std::string leaf() const;    ///< path without the section
  [[nodiscard]] bool required() const;
};

/// All keys, grouped by section, in the order of documentation.
std::span<const SceneKey> scene_table();

/// Help line of a section; "" for the keys outside any.
std::string section_help(const std::string& section);

/// What a key accepts, for messages and documentation: "a number in (0, 100] g_per_cm3", "one of a, b".
std::string allowed_text(const SceneKey& key);

/// The default in TOML notation, "" if there is none.
std::string default_text(const SceneKey& key);

/// Shortest decimal notation that reads back to exactly `value`, always a TOML float.
std::string shortest_number(double value);

} // namespace undula
