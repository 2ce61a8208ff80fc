#include "apps/output/scene_schema.hpp"

#include <algorithm>
#include <string>
#include <type_traits>

#include "apps/apps.hpp"
#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_table.hpp"

namespace undula::apps {
namespace {

using Json = nlohmann::ordered_json;

// Characters as the parser refuses them, see SceneKey.
constexpr const char* label_pattern = R"(^[^./\\\u0000-\u001f\u007f][^/\\\u0000-\u001f\u007f]*$)";
constexpr const char* name_pattern = R"(^[^,"'/\\\u0000-\u001f\u007f]*$)";
constexpr const char* entry_pattern = "^[A-Za-z0-9_]+$";

Json number_schema(const AllowedRange& allowed) {
  return {{"type", "number"},
          {allowed.low_open ? "exclusiveMinimum" : "minimum", allowed.low},
          {allowed.high_open ? "exclusiveMaximum" : "maximum", allowed.high}};
}

/// A number, or a table of one with its tolerance, which has room in the range on both sides. The words on
/// numbers say nothing of tables and the other way round, so that an editor can name the bound that is
/// broken.
Json real_schema(const AllowedRange& allowed) {
  Json schema = number_schema(allowed);
  schema["type"] = Json::array({"number", "object"});
  schema["properties"] = {
      {"value", number_schema(allowed)},
      {"tolerance", {{"type", "number"}, {"minimum", 0}, {"maximum", allowed.high / 2 - allowed.low / 2}}}};
  schema["required"] = Json::array({"value"});
  schema["additionalProperties"] = false;
  return schema;
}

Json text_schema() { return {{"type", "string"}}; }

Json expression_schema() { return {{"type", Json::array({"string", "number"})}}; }

Json list_schema(const Json& items) { return {{"type", "array"}, {"items", items}}; }

Json pair_schema(const Json& items) {
  Json schema = list_schema(items);
  schema["minItems"] = 2;
  schema["maxItems"] = 2;
  return schema;
}

Json point_schema() {
  return pair_schema(number_schema({-largest_coordinate, largest_coordinate, false, false}));
}

Json value_schema(const SceneKey& key) {
  return std::visit(
      [&](const auto& typed) -> Json {
        using Type = std::remove_cvref_t<decltype(typed)>;
        if constexpr (std::is_same_v<Type, RealKey>) {
          return real_schema(typed.allowed);
        } else if constexpr (std::is_same_v<Type, IntegerKey>) {
          return {{"type", "integer"}, {"minimum", typed.low}, {"maximum", typed.high}};
        } else if constexpr (std::is_same_v<Type, ChoiceKey>) {
          Json names = Json::array();
          for (const auto& [name, enumerator] : typed.available) {
            names.push_back(name);
          }
          return {{"enum", names}};
        } else if constexpr (std::is_same_v<Type, TextKey>) {
          return {{"type", "string"}, {"pattern", label_pattern}, {"maxLength", 200}};
        } else if constexpr (std::is_same_v<Type, FileKey>) {
          return text_schema();
        } else if constexpr (std::is_same_v<Type, FileListKey>) {
          return list_schema(text_schema());
        } else if constexpr (std::is_same_v<Type, ExpressionKey>) {
          return expression_schema();
        } else if constexpr (std::is_same_v<Type, ExpressionPairKey>) {
          return pair_schema(expression_schema());
        } else if constexpr (std::is_same_v<Type, PositionKey>) {
          return point_schema();
        } else if constexpr (std::is_same_v<Type, PositionListKey>) {
          return list_schema(point_schema());
        } else {
          Json name = {{"type", "string"}, {"pattern", name_pattern}};
          if constexpr (std::is_same_v<Type, NameKey>) {
            return name;
          }
          name["minLength"] = 1;
          return list_schema(name);
        }
      },
      key.value);
}

/// Null where there is none.
Json default_value(const SceneKey& key) {
  return std::visit(
      [](const auto& typed) -> Json {
        using Type = std::remove_cvref_t<decltype(typed)>;
        if constexpr (std::is_same_v<Type, RealKey> || std::is_same_v<Type, IntegerKey>) {
          return typed.fallback ? Json(*typed.fallback) : Json();
        } else if constexpr (std::is_same_v<Type, ChoiceKey> || std::is_same_v<Type, ExpressionKey>) {
          return typed.fallback.empty() ? Json() : Json(typed.fallback);
        } else {
          return {};
        }
      },
      key.value);
}

Json key_schema(const SceneKey& key) {
  Json schema = value_schema(key);
  std::string help = key.help + "\n\nAccepts " + allowed_text(key) + ".";
  if (const std::string text = published_text(key); !text.empty()) {
    help += " With stabilisation.weights = \"published\": " + text + ".";
  }
  if (const std::string text = quadratic_text(key); !text.empty()) {
    help += " With space.order = 2: " + text + ".";
  }
  schema["description"] = help;
  if (const Json fallback = default_value(key); !fallback.is_null()) {
    schema["default"] = fallback;
  }
  return schema;
}

Json table_schema(const std::string& help) {
  return {{"type", "object"},
          {"description", help},
          {"properties", Json::object()},
          {"additionalProperties", false}};
}

/// [body.NAME]: any name, the same keys.
Json entries_schema(const EntryKind& kind) {
  Json entry = table_schema(kind.help);
  Json required = Json::array();
  for (const SceneKey& key : entry_keys(kind.kind, "NAME")) {
    entry["properties"][key.leaf()] = key_schema(key);
    if (key.required()) {
      required.push_back(key.leaf());
    }
  }
  if (!required.empty()) {
    entry["required"] = required;
  }
  return {{"type", "object"},
          {"description", kind.help},
          {"patternProperties", {{entry_pattern, entry}}},
          {"additionalProperties", false}};
}

Json constants_schema() {
  const SceneKey& key = entry_keys(constants_section, "NAME").front();
  return {{"type", "object"},
          {"description", "Numbers that expressions use by name. General problems only."},
          {"patternProperties", {{"^[A-Za-z_][A-Za-z0-9_]*$", value_schema(key)}}},
          {"additionalProperties", false}};
}

/// Every key of every scene.
Json all_properties() {
  Json properties = Json::object();
  for (const SceneKey& key : scene_table()) {
    const std::string section = key.section();
    if (!section.empty() && !properties.contains(section)) {
      properties[section] = table_schema(section_help(section));
    }
    (section.empty() ? properties : properties[section]["properties"])[key.leaf()] = key_schema(key);
  }
  properties[constants_section] = constants_schema();
  for (const EntryKind& kind : entry_kinds()) {
    properties[kind.kind] = entries_schema(kind);
  }
  return properties;
}

/// Refuses the keys that do not apply to `scene`.
Json without_foreign_keys(const Scene& scene) {
  Json properties = Json::object();
  for (const SceneKey& key : scene_table()) {
    if (!key.applies_to(scene)) {
      (key.section().empty() ? properties : properties[key.section()]["properties"])[key.leaf()] = false;
    }
  }
  if (!scene.problem.general) {
    properties[constants_section] = false;
    for (const EntryKind& kind : entry_kinds()) {
      if (kind.scope == Scope::general) {
        properties[kind.kind] = false;
      }
    }
  }
  return {{"properties", properties}};
}

/// Asks for the keys that `scene` cannot do without.
Json with_required_keys(const Scene& scene) {
  Json required = Json::array(), properties = Json::object();
  const auto ask = [](Json& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) {
      list.push_back(name);
    }
  };
  for (const SceneKey& key : keys_of(scene)) {
    if (!key.required()) {
      continue;
    }
    if (key.section().empty()) {
      ask(required, key.leaf());
      continue;
    }
    ask(required, key.section());
    Json& section = properties[key.section()]["required"];
    if (section.is_null()) {
      section = Json::array();
    }
    ask(section, key.leaf());
  }
  return {{"required", required}, {"properties", properties}};
}

Json has(const char* name) { return {{"required", Json::array({name})}}; }
Json no(const Json& condition) { return {{"not", condition}}; }
Json both(const Json& a, const Json& b) { return {{"allOf", Json::array({a, b})}}; }
Json either(const Json& a, const Json& b) { return {{"anyOf", Json::array({a, b})}}; }
Json inside(const char* section, const Json& condition) {
  return {{"required", Json::array({section})}, {"properties", {{section, condition}}}};
}

} // namespace

Json scene_schema() {
  // What the parser goes by, too: SceneParser::read_file, has_fluid, keys_of.
  const Json general = either(has("domain"), has("body"));
  const Json fluid = inside("domain", either(has("outline_mm"), has("radius_mm")));
  const Json by_voltage = inside("operating_point", {{"required", Json::array({"drive"})},
                                                     {"properties", {{"drive", {{"const", "voltage"}}}}}});

  const Json hose = inside("model", {{"required", Json::array({"machine"})},
                                     {"properties", {{"machine", {{"const", "peristaltic-pump"}}}}}});
  const Json wave_pump = both(no(general), no(hose));

  Scene pump, pump_by_voltage, peristaltic, flow, solids;
  pump_by_voltage.operating_point.drive = Drive::voltage;
  peristaltic.machine = Machine::peristaltic_pump;
  peristaltic.operating_point.drive = Drive::rollers;
  flow.problem.general = solids.problem.general = true;
  flow.problem.domain.shape.radius = 1;

  const auto when = [](const Json& condition, const Json& then) {
    return Json{{"if", condition}, {"then", then}};
  };
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "A scene of Undula"},
          {"description", "Everything that one computation needs; `undula check` says the rest."},
          {"type", "object"},
          {"properties", all_properties()},
          {"additionalProperties", false},
          {"allOf", Json::array({when(general, without_foreign_keys(flow)),
                                 when(wave_pump, without_foreign_keys(pump)),
                                 when(both(no(general), hose), without_foreign_keys(peristaltic)),
                                 when(both(no(general), hose), with_required_keys(peristaltic)),
                                 when(both(general, fluid), with_required_keys(flow)),
                                 when(both(general, no(fluid)), with_required_keys(solids)),
                                 when(both(wave_pump, by_voltage), with_required_keys(pump_by_voltage)),
                                 when(both(wave_pump, no(by_voltage)), with_required_keys(pump))})}};
}

} // namespace undula::apps
