#include "fom/scene/scene_reference.hpp"

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_table.hpp"

namespace undula::fom {
namespace {

/// Bars would end the cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '|' ? "\\|" : std::string(1, c);
  }
  return escaped;
}

std::string planned_text(const SceneKey& key) {
  const auto* choice = std::get_if<ChoiceKey>(&key.value);
  if (choice == nullptr || choice->planned.empty()) {
    return "";
  }
  std::string names;
  for (const std::string& name : choice->planned) {
    names += (names.empty() ? "`" : ", `") + name + "`";
  }
  return " (planned, refused by this version: " + names + ")";
}

std::string default_cell(const SceneKey& key) {
  if (key.required()) {
    return "required";
  }
  const std::string text = default_text(key), published = published_text(key),
                    quadratic = quadratic_text(key);
  return (text.empty() ? "none" : "`" + text + "`") +
         (published.empty() ? "" : ", published `" + published + "`") +
         (quadratic.empty() ? "" : ", of order 2 `" + quadratic + "`");
}

constexpr const char* table_head = "\n| key | accepts | default | meaning |\n|---|---|---|---|\n";

std::string row(const SceneKey& key) {
  const bool entry = static_cast<bool>(entry_of(key.path));
  const std::string mark = entry ? "" : scope_mark(key.scope), scope = mark + (mark.empty() ? "" : " ");
  return "| `" + key.leaf() + "`" + (key.shapes_state ? "" : " *") + " | " + cell(allowed_text(key)) + " | " +
         cell(default_cell(key)) + " | " + scope + cell(key.help + planned_text(key)) + " |\n";
}

} // namespace

std::string scene_reference() {
  std::string page =
      "# Scene reference\n\n"
      "A scene is a TOML file that says everything one computation needs. This page is printed by\n"
      "`undula check --reference` from the table that also parses, checks and documents scenes\n"
      "(`fom/scene/scene_table.cpp`).\n\n"
      "- Units are part of the key names. A key with another unit is refused, with the key to use instead.\n"
      "- An unknown key is refused, with the nearest valid one and the line.\n"
      "- Relative paths start at the scene file; in `--set` at the working directory.\n"
      "- `--set section.key=value` overrides a key; it may be repeated. Quotes around names may be left "
      "out.\n"
      "- A number of a range (not an integer) may stand with its tolerance, in the file and in `--set`:\n"
      "  `stroke_mm = { value = 0.53, tolerance = 0.01 }`. The tolerance, in the unit of the key, is half "
      "the "
      "width of the\n"
      "  interval that holds the true value with 95 % probability; the interval must lie within the range of "
      "the key.\n"
      "  `--set` with a bare number keeps the tolerance of the file, with such a table replaces it. "
      "Tolerances "
      "shape no\n"
      "  computed state; they are what error bands and calibration start from.\n"
      "- Every output records the resolved scene. Keys marked * may change when a run goes on from a "
      "checkpoint.\n";
  page +=
      "- Keys marked (pump) belong to scenes of any pump, keys marked (wave pump) or (peristaltic pump) to "
      "those\n  of one (`model.machine`), keys marked (general) to scenes with `[domain]` or `[body.NAME]`, "
      "which state any other\n  plane or axisymmetric problem.\n"
      "- Expressions are arithmetic in `x`, `y` (plane) or `r`, `z` (axisymmetric) in mm, `t` in s, `pi`, "
      "the\n"
      "  names of `[constants]`, and `ramp(t, T)`, which rises smoothly from 0 at t = 0 to 1 at t = T; with "
      "the "
      "functions and\n  operators of muParser (`sin`, `exp`, `sqrt`, `min`, `^`, `<`, `&&`, `a ? b : c`, "
      "...).\n";
  std::string section = "-";
  for (const SceneKey& key : scene_table()) {
    if (key.section() != section) {
      section = key.section();
      page += section.empty() ? "\n## Outside sections\n"
                              : "\n## [" + section + "]\n\n" + section_help(section) + "\n";
      page += table_head;
    }
    page += row(key);
  }
  page += "\n## [constants]\n\nNumbers that expressions use by name: `U = 20.0`. General problems only.\n";
  for (const EntryKind& kind : entry_kinds()) {
    page += "\n## [" + kind.kind + ".NAME]\n\n" + kind.help + "\n" + table_head;
    for (const SceneKey& key : entry_keys(kind.kind, "NAME")) {
      page += row(key);
    }
  }
  return page;
}

std::string scene_keys_help() {
  std::string text = "Keys for --set key=value (all of docs/scene.md: undula check --reference):\n";
  for (const SceneKey& key : scene_table()) {
    text += "  " + key.path + ": " + allowed_text(key) + "\n";
  }
  for (const EntryKind& kind : entry_kinds()) {
    for (const SceneKey& key : entry_keys(kind.kind, "NAME")) {
      text += "  " + key.path + ": " + allowed_text(key) + "\n";
    }
  }
  return text;
}

} // namespace undula::fom
