// Texts made from single keys of the scene table: ranges, defaults, numbers.

#include "fom/scene/scene_table.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

} // namespace

bool SceneKey::applies_to(const Scene& scene) const {
  const bool general = scene.problem.general;
  switch (scope) {
    case Scope::any:
      return true;
    case Scope::general:
      return general;
    case Scope::pump:
      return !general;
    case Scope::wave_pump:
      return !general && scene.machine == Machine::wave_pump;
    case Scope::peristaltic_pump:
      return !general && scene.machine == Machine::peristaltic_pump;
  }
  return false;
}

std::string scope_mark(Scope scope) {
  switch (scope) {
    case Scope::any:
      break;
    case Scope::general:
      return "(general)";
    case Scope::pump:
      return "(pump)";
    case Scope::wave_pump:
      return "(wave pump)";
    case Scope::peristaltic_pump:
      return "(peristaltic pump)";
  }
  return "";
}

std::string scope_text(Scope scope) {
  switch (scope) {
    case Scope::any:
      return "any scene";
    case Scope::general:
      return "scenes with [domain] or [body.NAME]";
    case Scope::pump:
      return "scenes of a pump, without [domain] and [body.NAME]";
    case Scope::wave_pump:
      return "scenes of a wave pump, without [domain] and [body.NAME]";
    case Scope::peristaltic_pump:
      return "scenes with model.machine = \"peristaltic-pump\"";
  }
  return "";
}

std::string SceneKey::section() const {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string SceneKey::leaf() const {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

bool SceneKey::required() const {
  return std::visit(
      Overloaded{[](const RealKey& key) { return !key.fallback; },
                 [](const IntegerKey& key) { return !key.fallback; }, [](const ChoiceKey&) { return false; },
                 [](const TextKey&) { return true; }, [](const auto&) { return false; }},
      value);
}

std::string allowed_text(const SceneKey& key) {
  return std::visit(
      Overloaded{
          [&](const RealKey& real) {
            const AllowedRange& range = real.allowed;
            return "a number in " + std::string(range.low_open ? "(" : "[") + plain_number(range.low) + ", " +
                   plain_number(range.high) + (range.high_open ? ")" : "]") +
                   (key.unit.empty() ? "" : " " + key.unit);
          },
          [](const IntegerKey& integer) {
            return "an integer in [" + std::to_string(integer.low) + ", " + std::to_string(integer.high) +
                   "]";
          },
          [](const ChoiceKey& choice) {
            std::string text;
            for (const auto& [name, enumerator] : choice.available) {
              text += (text.empty() ? "\"" : ", \"") + name + "\"";
            }
            return (choice.available.size() == 1 ? "" : "one of ") + text;
          },
          [](const TextKey&) {
            return std::string("a text in quotes, not empty, without / and \\, at most 200 bytes");
          },
          [](const FileKey&) { return std::string("the name of an existing file, in quotes"); },
          [](const FileListKey&) {
            return std::string("a list of names of existing files, [\"a.msh\", \"b.msh\"]");
          },
          [](const ExpressionKey&) { return std::string("an expression in quotes, or a number"); },
          [](const ExpressionPairKey&) {
            return std::string("two expressions or numbers, [\"0\", \"2*t\"]");
          },
          [](const PositionKey&) { return std::string("a point, [1.0, 2.0], within 1e6 mm of the origin"); },
          [](const PositionListKey&) {
            return std::string("a list of points, [[0.0, 0.0], [1.0, 2.0]], within 1e6 mm of the origin");
          },
          [](const NameKey&) { return std::string("a name in quotes, without commas, quotes, / and \\"); },
          [](const NameListKey&) {
            return std::string("a list of names, [\"a\", \"b\"], without commas, quotes, / and \\");
          }},
      key.value);
}

std::string default_text(const SceneKey& key) {
  return std::visit(Overloaded{[](const RealKey& real) {
                                 return real.fallback ? shortest_number(*real.fallback) : std::string();
                               },
                               [](const IntegerKey& integer) {
                                 return integer.fallback ? std::to_string(*integer.fallback) : std::string();
                               },
                               [](const ChoiceKey& choice) { return "\"" + choice.fallback + "\""; },
                               [](const auto&) { return std::string(); }},
                    key.value);
}

std::string published_text(const SceneKey& key) {
  if (const auto* real = std::get_if<RealKey>(&key.value)) {
    return real->published && real->published != real->fallback ? shortest_number(*real->published) : "";
  }
  const auto* choice = std::get_if<ChoiceKey>(&key.value);
  return choice != nullptr && !choice->published.empty() ? "\"" + choice->published + "\"" : "";
}

std::string quadratic_text(const SceneKey& key) {
  const auto* real = std::get_if<RealKey>(&key.value);
  return real != nullptr && real->quadratic && real->quadratic != real->fallback
             ? shortest_number(*real->quadratic)
             : "";
}

std::string shortest_number(double value) {
  std::string number = exact_number(value);
  // TOML tells floats from integers by the point or the exponent; "inf" and "nan" are floats.
  if (number.find_first_of(".en") == std::string::npos) {
    number += ".0";
  }
  return number;
}

} // namespace undula::fom
