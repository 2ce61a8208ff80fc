// The surface form of a scene as one declarative table: key, unit, allowed range, default, help and the field
// of Scene it fills. The parser, the checks, the writer, `--set`, `undula check` and docs/scene.md all read
// it.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fom/scene/scene.hpp"

namespace undula::fom {

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
  std::function<double&(Scene&)> field;
  double cgs_per_unit = 1;
  AllowedRange allowed;
  std::optional<double> fallback;       ///< surface unit; none: the key is required
  std::optional<double> published = {}; ///< in place of `fallback` with stabilisation.weights = "published"
  std::optional<double> quadratic = {}; ///< in place of both with space.order = 2
};

struct IntegerKey {
  std::function<int&(Scene&)> field;
  int low = 0;
  int high = 0;
  std::optional<int> fallback;
};

/// One of a few names.
struct ChoiceKey {
  std::function<int(Scene&)> get;
  std::function<void(Scene&, int)> set;
  std::vector<std::pair<std::string, int>> available; ///< name, enumerator
  std::vector<std::string> planned;                   ///< in the design, refused by this version
  std::string fallback;
  std::string published = {}; ///< as for RealKey; "": the same
};

/// A label that may become part of file names and of scripts: not empty, no control characters, no / and \,
/// no . in front, at most 200 bytes.
struct TextKey {
  std::function<std::string&(Scene&)> field;
};

/// An existing file; empty when the key is left out.
struct FileKey {
  std::function<std::filesystem::path&(Scene&)> field;
};

/// A list of existing files; empty when the key is left out.
struct FileListKey {
  std::function<std::vector<std::filesystem::path>&(Scene&)> field;
};

/// Arithmetic in the coordinates (mm) and time (s), see scene/expression.hpp; a plain number counts as one.
struct ExpressionKey {
  std::function<std::string&(Scene&)> field;
  std::string fallback; ///< may be empty
};

/// Two expressions, one per coordinate.
struct ExpressionPairKey {
  std::function<std::array<std::string, 2>&(Scene&)> field;
};

/// Coordinates of points, in mm, are not larger than this.
inline constexpr double largest_coordinate = 1e6;

/// A point, [1.0, 2.0]; the origin when the key is left out.
struct PositionKey {
  std::function<Position&(Scene&)> field;
  double cgs_per_unit = 1;
};

/// Points, [[0.0, 0.0], [1.0, 2.0]]; none when the key is left out.
struct PositionListKey {
  std::function<std::vector<Position>&(Scene&)> field;
  double cgs_per_unit = 1;
};

/// Names in quotes, without control characters, commas, quotes, / and \; "" or none when the key is left out.
struct NameKey {
  std::function<std::string&(Scene&)> field;
};
struct NameListKey {
  std::function<std::vector<std::string>&(Scene&)> field;
};

/// Which scenes have a key.
enum class Scope {
  any,
  pump,             ///< of any pump
  wave_pump,        ///< of a wave pump: geometry from a profile or meshes, an actuator
  peristaltic_pump, ///< of a peristaltic pump: a hose and rollers
  general           ///< with a domain and bodies of their own (Scene::problem)
};

struct SceneKey {
  std::string path; ///< "section.key_unit", or "key" outside any section
  std::string unit; ///< "" for numbers without a unit, names and files; otherwise also the end of `path`
  std::string help;
  bool shapes_state; ///< false: a checkpoint stays valid when the value changes (labels, lengths, campaigns)
  std::variant<RealKey, IntegerKey, ChoiceKey, TextKey, FileKey, FileListKey, ExpressionKey,
               ExpressionPairKey, PositionKey, PositionListKey, NameKey, NameListKey>
      value;
  Scope scope = Scope::any;

  [[nodiscard]] bool applies_to(const Scene& scene) const;
  [[nodiscard]] std::string section() const; ///< "" outside any section; of an entry "body.flag"
  [[nodiscard]] std::string leaf() const;    ///< path without the section
  [[nodiscard]] bool required() const;
};

/// All keys, grouped by section, in the order of documentation.
std::span<const SceneKey> scene_table();

/// "(pump)", "(wave pump)", ... as the reference marks keys; "" for keys of any scene.
std::string scope_mark(Scope scope);

/// The scenes that a scope stands for, for messages.
std::string scope_text(Scope scope);

/// Help line of a section; "" for the keys outside any.
std::string section_help(const std::string& section);

/// What a key accepts, for messages and documentation: "a number in (0, 100] g_per_cm3", "one of a, b".
std::string allowed_text(const SceneKey& key);

/// The default in TOML notation, "" if there is none.
std::string default_text(const SceneKey& key);

/// The default with stabilisation.weights = "published", "" if that is the same.
std::string published_text(const SceneKey& key);

/// The default with space.order = 2, "" if that is the same.
std::string quadratic_text(const SceneKey& key);

/// Shortest decimal notation that reads back to exactly `value`, always a TOML float.
std::string shortest_number(double value);

} // namespace undula::fom
