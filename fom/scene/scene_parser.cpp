// read_scene and parse_scene: TOML nodes to fields of a scene, by the table.
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <type_traits>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/expression.hpp"
#include "fom/scene/scene_checks.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_key_search.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "fom/scene/stated_speed.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

/// What a message says about the place of a node, and where its relative paths start.
struct Origin {
  std::string label;
  bool has_lines = true;
  std::filesystem::path base;

  [[nodiscard]] std::string at(const toml::source_region& source) const {
    return has_lines ? label + ":" + std::to_string(source.begin.line) : label;
  }
};

std::string in_quotes(std::string_view text) { return '"' + std::string(text) + '"'; }

/// The node as it would stand in the file, cut to one line.
std::string seen_text(const toml::node& node) {
  std::ostringstream stream;
  node.visit([&](const auto& typed) { stream << typed; });
  std::string text = stream.str();
  for (char& c : text) {
    c = c == '\n' ? ' ' : c;
  }
  constexpr std::size_t longest = 80;
  if (text.size() > longest) {
    text = text.substr(0, longest) + " ...";
  }
  return text;
}

/// Fills one scene from the file and the overrides.
class SceneParser {
public:
  /// The whole file.
  void read_file(const toml::table& file, const Origin& origin) {
    scene.problem.general = file.contains("domain") || file.contains("body");
    // What expressions depend on comes first.
    const auto is_first = [](std::string_view section) {
      return section == constants_section || section == "model";
    };
    read_table(file, "", origin, is_first);
    read_table(file, "", origin, [&](std::string_view section) { return !is_first(section); });
  }

  /// The keys of a table that `counts` accepts.
  void read_table(
      const toml::table& table, const std::string& prefix, const Origin& origin,
      const std::function<bool(std::string_view)>& counts = [](std::string_view) { return true; }) {
    for (const auto& [key, node] : table) {
      if (!counts(key.str())) {
        continue;
      }
      const std::string path = prefix + std::string(key.str());
      if (prefix.empty() && entry_of(path + ".NAME")) {
        read_entries(path, node, origin.at(key.source()), origin);
        continue;
      }
      const bool section = prefix.empty() && is_section(path);
      if (section && node.is_table()) {
        read_table(*node.as_table(), path + ".", origin);
      } else if (section) {
        throw InputError(in_quotes(path) + " is a section, not a value", seen_text(node),
                         "a table, [" + path + "], with keys below it", origin.at(key.source()));
      } else if (const SceneKey* known = find_key(path)) {
        check_scope(*known, path + " = " + seen_text(node), origin.at(key.source()));
        assign(*known, node, origin);
        given_.insert(path);
        scene.places[path] = origin.at(key.source());
      } else {
        refuse_unknown(path, path + " = " + seen_text(node), node.is_table(), origin.at(key.source()));
      }
    }
  }

  /// `text` is "section.key=value"; names and files may stand without quotes.
  void read_override(const std::string& text) {
    const Origin origin{"--set " + text, false, std::filesystem::current_path()};
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      throw InputError("an override is not of the form key=value", in_quotes(text),
                       "for instance operating_point.head_mmHg=55", origin.label);
    }
    const std::string path = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    const EntryName entry = entry_of(path);
    const EntryKind* kind = find_entry_kind(entry.kind);
    if (kind != nullptr && kind->added_by_override && is_plain_name(entry.name)) {
      add_entry(scene, entry.kind, entry.name);
    }
    check_entry_exists(scene, path, origin.label);
    const SceneKey* key = find_key(path);
    if (key == nullptr) {
      refuse_unknown(path, text, false, origin.label);
    }
    check_scope(*key, text, origin.label);
    const bool is_text =
        std::holds_alternative<ChoiceKey>(key->value) || std::holds_alternative<TextKey>(key->value) ||
        std::holds_alternative<FileKey>(key->value) || std::holds_alternative<ExpressionKey>(key->value) ||
        std::holds_alternative<NameKey>(key->value);
    if (is_text && value.front() != '"' && value.front() != '\'') {
      assign(*key, toml::value<std::string>(value), origin);
    } else {
      const toml::table table = parse_override_value(value, *key, origin);
      assign(*key, *table.get("value"), origin);
    }
    given_.insert(path);
    scene.places[path] = origin.label;
  }

  /// Defaults for what was left out; refuses missing keys.
  void fill_defaults(const Origin& origin) {
    for (const SceneKey& key : keys_of(scene)) {
      if (given_.contains(key.path)) {
        continue;
      }
      if (key.required()) {
        const std::string place =
            key.section().empty() ? " before the first section" : " in section [" + key.section() + "]";
        throw InputError("key " + in_quotes(key.path) + " (" + key.help + ") is missing", "nothing",
                         key.leaf() + " = " + allowed_text(key), origin.label + "," + place);
      }
      const bool published = scene.default_weights == DefaultWeights::published;
      if (const auto* real = std::get_if<RealKey>(&key.value)) {
        double value = published && real->published ? *real->published : *real->fallback;
        if (scene.velocity_order == 2 && real->quadratic) value = *real->quadratic;
        real->field(scene) = value * real->cgs_per_unit;
      } else if (const auto* integer = std::get_if<IntegerKey>(&key.value)) {
        integer->field(scene) = *integer->fallback;
      } else if (const auto* choice = std::get_if<ChoiceKey>(&key.value)) {
        const bool other = published && !choice->published.empty();
        choose(key, *choice, other ? choice->published : choice->fallback, "the scene table");
      } else if (const auto* expression = std::get_if<ExpressionKey>(&key.value)) {
        expression->field(scene) = expression->fallback;
      }
    }
  }

  Scene scene;

private:
  static toml::table parse_override_value(const std::string& value, const SceneKey& key,
                                          const Origin& origin) {
    try {
      // On one line, so that a value cannot bring keys of its own.
      if (value.find_first_of("\r\n") == std::string::npos) {
        toml::table table = toml::parse("value = " + value);
        return table;
      }
    } catch (const toml::parse_error&) {
    }
    throw InputError("key " + in_quotes(key.path) + " has a value of the wrong type", value,
                     allowed_text(key), origin.label);
  }

  /// [body.flag], [body.tail], ..., or the numbers of [constants].
  void read_entries(const std::string& kind, const toml::node& node, const std::string& where,
                    const Origin& origin) {
    const bool constants = kind == constants_section;
    if (!node.is_table()) {
      throw InputError(in_quotes(kind) + " is a section, not a value", seen_text(node),
                       constants ? "a table, [constants], with numbers below it"
                                 : "tables with names, [" + kind + ".NAME], with keys below them",
                       where);
    }
    for (const auto& [key, entry] : *node.as_table()) {
      const std::string name(key.str());
      const std::string at = origin.at(key.source());
      if (!scene.problem.general && (constants || find_entry_kind(kind)->scope == Scope::general)) {
        throw InputError("section " + in_quotes(kind) + " makes no sense in a scene of a pump",
                         kind + "." + name, "scenes with [domain] or [body.NAME]", at);
      }
      if (!constants && !entry.is_table()) {
        throw InputError(in_quotes(kind + "." + name) + " stands outside of a named section",
                         seen_text(entry), "keys below [" + kind + ".NAME]", at);
      }
      if (!is_free_name(name) && (constants || !is_plain_name(name))) {
        throw InputError("this name cannot stand for " + std::string(constants ? "a constant" : "an entry"),
                         in_quotes(name),
                         constants ? "letters, digits and _, none of the names that expressions know"
                                   : "letters, digits and _",
                         at);
      }
      add_entry(scene, kind, name);
      if (constants) {
        const std::string path = kind + "." + name;
        assign(*find_key(path), entry, origin);
        given_.insert(path);
      } else {
        read_table(*entry.as_table(), kind + "." + name + ".", origin);
      }
    }
  }

  static bool is_plain_name(const std::string& name) {
    return !name.empty() &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  }

  void check_scope(const SceneKey& key, const std::string& seen, const std::string& where) const {
    if (!key.applies_to(scene)) {
      throw InputError("key " + in_quotes(key.path) + " does not apply to this scene", seen,
                       scope_text(key.scope), where);
    }
  }

  [[noreturn]] static void refuse_unknown(const std::string& path, const std::string& seen, bool is_table,
                                          const std::string& where) {
    if (const SceneKey* key = same_quantity(path)) {
      throw InputError(
          "key " + in_quotes(path) + " does not carry the unit that scenes use for this quantity", seen,
          in_quotes(key->path) + ", " + allowed_text(*key), where);
    }
    if (is_table) {
      std::string sections;
      for (const SceneKey& key : scene_table()) {
        const std::string section = key.section();
        if (!section.empty() && sections.find("[" + section + "]") == std::string::npos) {
          sections += (sections.empty() ? "[" : ", [") + section + "]";
        }
      }
      for (const EntryKind& kind : entry_kinds()) {
        sections += ", [" + kind.kind + ".NAME]";
      }
      sections += ", [" + std::string(constants_section) + "]";
      throw InputError("unknown section " + in_quotes(path), "[" + path + "]", sections, where);
    }
    throw InputError("unknown key " + in_quotes(path), seen,
                     "the nearest valid key is " + in_quotes(nearest_key(path).path), where);
  }

  [[noreturn]] static void refuse_value(const SceneKey& key, const char* why, const std::string& seen,
                                        const std::string& where) {
    throw InputError("key " + in_quotes(key.path) + " " + why, seen, allowed_text(key), where);
  }

  void assign_real(const SceneKey& key, const RealKey& real, const toml::node& node, double tolerance,
                   const std::string& where) {
    if (!node.is_number()) {
      refuse_value(key, "has a value of the wrong type", seen_text(node), where);
    }
    const double value = *node.value<double>();
    if (!real.allowed.contains(value)) { // refuses nan as well
      refuse_value(key, "is out of range", seen_text(node), where);
    }
    if (!real.allowed.contains(value - tolerance) || !real.allowed.contains(value + tolerance)) {
      refuse_value(key, "leaves its range within its tolerance",
                   "from " + shortest_number(value - tolerance) + " to " +
                       shortest_number(value + tolerance) + ", " + shortest_number(value) +
                       " with a tolerance of " + shortest_number(tolerance),
                   where);
    }
    real.field(scene) = value * real.cgs_per_unit;
  }

  /// { value = ..., tolerance = ... }; without a tolerance the value counts as exact.
  void assign_with_tolerance(const SceneKey& key, const RealKey& real, const toml::table& table,
                             const Origin& origin) {
    const std::string form = "{ value = " + allowed_text(key) + ", tolerance = a number >= 0 }";
    for (const auto& [name, node] : table) {
      if (name.str() != "value" && name.str() != "tolerance") {
        const bool value_is_near =
            edit_distance(name.str(), "value") < edit_distance(name.str(), "tolerance");
        throw InputError(
            "unknown key " + in_quotes(name.str()) + " beside the value of " + in_quotes(key.path),
            std::string(name.str()) + " = " + seen_text(node),
            std::string("the nearest valid one is ") + (value_is_near ? "\"value\"" : "\"tolerance\"") +
                ", " + form,
            origin.at(name.source()));
      }
    }
    const toml::node* value = table.get("value");
    if (value == nullptr) {
      throw InputError("key " + in_quotes(key.path) + " has no value", seen_text(table), form,
                       origin.at(table.source()));
    }
    double tolerance = 0;
    if (const toml::node* stated = table.get("tolerance")) {
      tolerance = stated->is_number() ? *stated->value<double>() : -1;
      if (!std::isfinite(tolerance) || tolerance < 0) {
        throw InputError("the tolerance of key " + in_quotes(key.path) + " makes no sense",
                         "tolerance = " + seen_text(*stated),
                         "a finite number >= 0" + (key.unit.empty() ? "" : ", in " + key.unit),
                         origin.at(stated->source()));
      }
    }
    assign_real(key, real, *value, tolerance, origin.at(value->source()));
    set_tolerance(scene, key.path, tolerance);
  }

  void assign(const SceneKey& key, const toml::node& node, const Origin& origin) {
    const std::string where = origin.at(node.source());
    if (node.is_table() && node.as_table()->contains("tolerance") &&
        !std::holds_alternative<RealKey>(key.value)) {
      refuse_value(key, "takes no tolerance: it is not a real number", seen_text(node), where);
    }
    const auto wrong_type = [&] {
      refuse_value(key, "has a value of the wrong type", seen_text(node), where);
    };
    std::visit(
        [&](const auto& typed) {
          using Type = std::remove_cvref_t<decltype(typed)>;
          if constexpr (std::is_same_v<Type, RealKey>) {
            if (node.is_table()) {
              assign_with_tolerance(key, typed, *node.as_table(), origin);
            } else {
              assign_real(key, typed, node, tolerance_of(scene, key.path), where);
            }
          } else if constexpr (std::is_same_v<Type, IntegerKey>) {
            if (!node.is_integer()) {
              wrong_type();
            }
            const auto value = *node.value<std::int64_t>();
            if (value < typed.low || value > typed.high) {
              refuse_value(key, "is out of range", seen_text(node), where);
            }
            typed.field(scene) = static_cast<int>(value);
          } else if constexpr (std::is_same_v<Type, FileListKey> || std::is_same_v<Type, NameListKey>) {
            if (!node.is_array()) {
              wrong_type();
            }
            typed.field(scene).clear();
            for (const toml::node& entry : *node.as_array()) {
              if (!entry.is_string()) {
                wrong_type();
              }
              auto text = *entry.value<std::string>();
              if constexpr (std::is_same_v<Type, FileListKey>) {
                typed.field(scene).push_back(existing_file(key, text, origin, where));
              } else {
                if (text.empty()) {
                  refuse_value(key, "has a name that is empty", seen_text(node), where);
                }
                check_characters(key, text, ",\"'", where);
                typed.field(scene).push_back(std::move(text));
              }
            }
          } else if constexpr (std::is_same_v<Type, PositionKey>) {
            typed.field(scene) = position(key, node, typed.cgs_per_unit, where);
          } else if constexpr (std::is_same_v<Type, PositionListKey>) {
            if (!node.is_array()) {
              wrong_type();
            }
            typed.field(scene).clear();
            for (const toml::node& entry : *node.as_array()) {
              typed.field(scene).push_back(position(key, entry, typed.cgs_per_unit, where));
            }
          } else if constexpr (std::is_same_v<Type, ExpressionKey>) {
            typed.field(scene) = expression_text(key, node, where);
          } else if constexpr (std::is_same_v<Type, ExpressionPairKey>) {
            if (!node.is_array() || node.as_array()->size() != 2) {
              wrong_type();
            }
            for (std::size_t i = 0; i < 2; ++i) {
              typed.field(scene)[i] = expression_text(key, *node.as_array()->get(i), where);
            }
          } else {
            if (!node.is_string()) {
              wrong_type();
            }
            assign_text(key, typed, *node.value<std::string>(), origin, where);
          }
        },
        key.value);
  }

  static Position position(const SceneKey& key, const toml::node& node, double cgs_per_unit,
                           const std::string& where) {
    const toml::array* pair = node.as_array();
    if (pair == nullptr || pair->size() != 2 || !pair->get(0)->is_number() || !pair->get(1)->is_number()) {
      refuse_value(key, "has a point of the wrong form", seen_text(node), where);
    }
    Position result{};
    for (std::size_t i = 0; i < 2; ++i) {
      result[i] = *pair->get(i)->value<double>() * cgs_per_unit;
      if (!(std::abs(result[i]) <= largest_coordinate * cgs_per_unit)) { // refuses nan as well
        refuse_value(key, "has a point that is too far away", seen_text(node), where);
      }
    }
    return result;
  }

  [[nodiscard]] std::string expression_text(const SceneKey& key, const toml::node& node,
                                            const std::string& where) const {
    if (!node.is_string() && !node.is_number()) {
      refuse_value(key, "has a value of the wrong type", seen_text(node), where);
    }
    std::string text = node.is_string() ? *node.value<std::string>() : shortest_number(*node.value<double>());
    const Expression checked(text, scene.space, scene.problem.constants,
                             where + ", key " + in_quotes(key.path));
    return text;
  }

  template <typename Type>
  void assign_text(const SceneKey& key, const Type& typed, const std::string& text, const Origin& origin,
                   const std::string& where) {
    if constexpr (std::is_same_v<Type, ChoiceKey>) {
      choose(key, typed, text, where);
    } else if constexpr (std::is_same_v<Type, NameKey>) {
      check_characters(key, text, ",\"'", where);
      typed.field(scene) = text;
    } else if constexpr (std::is_same_v<Type, FileKey>) {
      typed.field(scene) = existing_file(key, text, origin, where);
    } else {
      if (text.empty()) {
        refuse_value(key, "is empty", in_quotes(text), where);
      }
      check_characters(key, text, "", where);
      constexpr std::size_t longest = 200;
      if (text.size() > longest || text.front() == '.') {
        refuse_value(key, text.front() == '.' ? "begins with a dot" : "is too long", in_quotes(text), where);
      }
      typed.field(scene) = text;
    }
  }

  /// Names become parts of file names, columns and scripts for gnuplot.
  static void check_characters(const SceneKey& key, const std::string& text, std::string_view others,
                               const std::string& where) {
    for (const char c : text) {
      const auto code = static_cast<unsigned char>(c);
      if (code < 0x20 || code == 0x7f) {
        char seen[8];
        std::snprintf(seen, sizeof seen, "\\x%02x", code);
        refuse_value(key, "has a control character", seen, where);
      }
      if (c == '/' || c == '\\' || others.find(c) != std::string_view::npos) {
        refuse_value(key, "has a character that names must not have", in_quotes(text), where);
      }
    }
  }

  void choose(const SceneKey& key, const ChoiceKey& choice, const std::string& text,
              const std::string& where) {
    for (const auto& [name, enumerator] : choice.available) {
      if (name == text) {
        choice.set(scene, enumerator);
        return;
      }
    }
    for (const std::string& name : choice.planned) {
      if (name == text) {
        refuse_value(key, "has a value that this version does not offer yet", in_quotes(text), where);
      }
    }
    refuse_value(key, "has an unknown value", in_quotes(text), where);
  }

  static std::filesystem::path existing_file(const SceneKey& key, const std::string& text,
                                             const Origin& origin, const std::string& where) {
    // As the file system resolves it: ".." behind a link to a folder is the parent of the folder itself.
    std::error_code ignored;
    const std::filesystem::path file = std::filesystem::weakly_canonical(origin.base / text, ignored);
    if (text.empty() || !std::filesystem::is_regular_file(file, ignored)) {
      refuse_value(key, "names a file that does not exist",
                   file.empty() ? (origin.base / text).string() : file.string(), where);
    }
    return file;
  }

  std::set<std::string> given_;
};

std::string file_text(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, ignored) || !stream) {
    throw InputError("the scene cannot be read", "no readable file " + in_quotes(file.string()),
                     "a scene file (TOML), see docs/scene.md", "command line");
  }
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  std::string text = buffer.str();
  if (text.find('\0') != std::string::npos) {
    throw InputError(
        "the scene is no text", "a binary file",
        "a scene file (TOML), see docs/scene.md; a reduced model (.h5) is for undula hq, validate "
        "and report",
        file.string());
  }
  return text;
}

} // namespace

Scene parse_scene(std::string_view text, const std::string& origin_name, const std::filesystem::path& base,
                  std::span<const std::string> overrides) {
  const Origin origin{origin_name, true, std::filesystem::absolute(base)};
  SceneParser parser;
  try {
    parser.read_file(toml::parse(text), origin);
  } catch (const toml::parse_error& error) {
    throw InputError("the scene is not valid TOML", std::string(error.description()),
                     "TOML 1.0, https://toml.io", origin.at(error.source()));
  }
  for (const std::string& override_text : overrides) {
    parser.read_override(override_text);
  }
  parser.fill_defaults(origin);
  if (parser.scene.machine == Machine::peristaltic_pump) {
    parser.scene.operating_point.drive = Drive::rollers;
  }
  check_consistency(parser.scene, origin_name);
  // Here, so that the resolved scene says it and a run that is prolonged beyond what it was derived from is
  // told.
  StabilisationWeights& weights = parser.scene.stabilisation;
  if (weights.reference_velocity == 0) {
    weights.reference_velocity = stated_speed(parser.scene);
    parser.scene.places.erase("stabilisation.reference_velocity_cm_per_s"); // of the 0 that asked for it
  }
  return parser.scene;
}

Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides) {
  // Links to folders are followed, a link to the file is not: its folder is that of the link.
  const std::filesystem::path named = std::filesystem::absolute(file);
  std::error_code ignored; // a folder that is not there is told of below
  const std::filesystem::path absolute =
      std::filesystem::weakly_canonical(named.parent_path(), ignored) / named.filename();
  Scene scene = parse_scene(file_text(file), file.string(), absolute.parent_path(), overrides);
  scene.file = absolute;
  return scene;
}

} // namespace undula::fom
