#include "fom/scene/commented_scene.hpp"

#include <toml++/toml.h>

#include <sstream>
#include <vector>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_table.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

/// Lines that begin with "# ", broken at spaces.
std::string comment(const std::string& text) {
  constexpr std::size_t width = 110;
  std::istringstream words(text);
  std::string lines, line = "#";
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

std::string toml_text(const std::string& text) {
  std::ostringstream quoted;
  const toml::value<std::string> value(text);
  quoted << toml::toml_formatter(value, toml::format_flags::none); // no '...', which scenes use nowhere
  return quoted.str();
}

/// A value on one line, its numbers with as many digits as they need.
std::string toml_text(const toml::node& node) {
  std::string text;
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& entry : *list) {
      text += (text.empty() ? "" : ", ") + toml_text(entry);
    }
    return "[" + text + "]";
  }
  if (const toml::table* table = node.as_table()) { // { value, tolerance }: the value first
    for (const auto& [key, entry] : *table) {
      const std::string pair = std::string(key.str()) + " = " + toml_text(entry);
      text = text.empty() ? pair : key.str() == "value" ? pair + ", " + text : text + ", " + pair;
    }
    return "{ " + text + " }";
  }
  if (node.is_string()) {
    return toml_text(*node.value<std::string>());
  }
  if (node.is_floating_point()) {
    return shortest_number(*node.value<double>());
  }
  std::ostringstream other;
  node.visit([&](const auto& typed) { other << typed; });
  return other.str();
}

class CommentedScene {
public:
  CommentedScene(const toml::table& scene, const CommentedSceneOptions& options)
      : scene_(scene), options_(options) {}

  std::string text() {
    Scene kind;
    kind.problem.general = scene_.contains("domain") || scene_.contains("body");
    if (scene_.at_path("model.machine").value_or(std::string()) == "peristaltic-pump") {
      kind.machine = Machine::peristaltic_pump;
      kind.operating_point.drive = Drive::rollers;
    }
    for (const SceneKey& key : scene_table()) {
      if (key.applies_to(kind)) {
        add(key, section_help(key.section()));
      }
    }
    add_constants();
    for (const EntryKind& entry : entry_kinds()) {
      if (const toml::table* entries = scene_[entry.kind].as_table()) {
        for (const auto& [name, node] : *entries) {
          for (const SceneKey& key : entry_keys(entry.kind, std::string(name.str()))) {
            add(key, entry.help);
          }
        }
      }
    }
    return text_;
  }

private:
  void add(const SceneKey& key, const std::string& help_of_section) {
    const std::string value = value_of(key), fallback = default_text(key);
    if (value.empty() && (!options_.all_keys || fallback.empty())) {
      return;
    }
    if (key.section() != section_) {
      section_ = key.section();
      text_ += "\n[" + section_ + "]\n" + (help_of_section.empty() ? "" : comment(help_of_section));
    }
    text_ += "\n" + comment(key.help) + comment("accepts " + allowed_text(key));
    text_ += value.empty() ? "# " + key.leaf() + " = " + fallback + "\n" : key.leaf() + " = " + value + "\n";
  }

  /// In TOML; empty where the scene does not state the key.
  std::string value_of(const SceneKey& key) const {
    if (const auto text = options_.texts.find(key.path); text != options_.texts.end()) {
      return toml_text(text->second);
    }
    const toml::node* node = scene_.at_path(key.path).node();
    return node == nullptr ? "" : toml_text(*node);
  }

  void add_constants() {
    const toml::table* constants = scene_[constants_section].as_table();
    if (constants == nullptr) {
      return;
    }
    text_ += std::string("\n[") + constants_section + "]\n" +
             comment("Numbers that expressions use by name.") + "\n";
    for (const auto& [name, node] : *constants) {
      text_ += std::string(name.str()) + " = " + toml_text(node) + "\n";
    }
  }

  const toml::table& scene_;
  const CommentedSceneOptions& options_;
  std::string text_, section_;
};

} // namespace

std::string commented_scene(std::string_view scene, const CommentedSceneOptions& options) {
  try {
    const toml::table table = toml::parse(scene);
    return CommentedScene(table, options).text();
  } catch (const toml::parse_error& error) {
    throw InputError("the scene is not valid TOML", std::string(error.description()),
                     "TOML 1.0, https://toml.io", "the scene to begin with");
  }
}

} // namespace undula::fom
