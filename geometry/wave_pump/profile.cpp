#include "geometry/wave_pump/profile.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

std::string place(const std::filesystem::path& file, const toml::source_region& source) {
  return file.string() + ":" + std::to_string(source.begin.line);
}

std::string text(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  auto line = out.str();
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line.size() > 80 ? line.substr(0, 77) + "..." : line;
}

std::string join(std::initializer_list<std::string_view> keys) {
  std::string all;
  for (const auto key : keys) all += (all.empty() ? "" : ", ") + std::string(key);
  return all;
}

/// Reads one file; every accessor throws InputError with the key and the line.
class Reader {
public:
  explicit Reader(std::filesystem::path file) : file_(std::move(file)) {
    if (!std::filesystem::is_regular_file(file_))
      throw InputError("the pump profile cannot be read", "no such file", "a TOML profile", file_.string());
    try {
      root_ = toml::parse_file(file_.string());
    } catch (const toml::parse_error& error) {
      throw InputError("the pump profile is not valid TOML", std::string(error.description()), "TOML 1.0",
                       place(file_, error.source()));
    }
  }

  const toml::table& root() const { return root_; }

  /// Every key of `table` must be among `known`.
  void only(const toml::table& table, const std::string& prefix,
            std::initializer_list<std::string_view> known) const {
    for (const auto& [key, node] : table)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        throw InputError("unknown key in the pump profile", prefix + std::string(key.str()), join(known),
                         place(file_, key.source()));
  }

  const toml::table& table(const std::string& key) const {
    const auto* node = root_.get(key);
    if (!node)
      throw InputError("a table is missing in the pump profile", "no [" + key + "]",
                       "[housing], [stator], [membrane], [magnet]", file_.string());
    if (!node->is_table())
      throw InputError("'" + key + "' must be a table", text(*node), "[" + key + "]",
                       place(file_, node->source()));
    return *node->as_table();
  }

  double number(const toml::table& table, const std::string& prefix, const std::string& key) const {
    return finite(member(table, prefix, key), prefix + key);
  }

  /// An array of pairs of numbers.
  ProfileCurve pairs(const toml::table& table, const std::string& prefix, const std::string& key) const {
    ProfileCurve curve;
    curve.key = prefix + key;
    const auto& node = member(table, prefix, key);
    if (!node.is_array())
      throw InputError("'" + curve.key + "' must be a list of points", text(node),
                       "[[r, z], [r, z], ...] in cm", place(file_, node.source()));
    for (const auto& entry : *node.as_array()) {
      const auto* pair = entry.as_array();
      if (!pair || pair->size() != 2)
        throw InputError("a point of '" + curve.key + "' is not a pair", text(entry), "two numbers in cm",
                         place(file_, entry.source()));
      curve.points.emplace_back(finite(*pair->get(0), curve.key), finite(*pair->get(1), curve.key));
      curve.lines.push_back(static_cast<int>(entry.source().begin.line));
    }
    return curve;
  }

  /// A number, or a table or list of them, that only people read.
  void only_numbers(const toml::node& node, const std::string& key) const {
    if (const auto* table = node.as_table()) {
      for (const auto& [name, entry] : *table) only_numbers(entry, key + "." + std::string(name.str()));
    } else if (const auto* list = node.as_array()) {
      for (const auto& entry : *list) only_numbers(entry, key);
    } else {
      finite(node, key);
    }
  }

  /// Numbers of a table within [materials].
  void materials(const std::string& name, std::initializer_list<std::string_view> known,
                 std::vector<ProfileStatement>& all) const {
    const std::string prefix = "materials." + name;
    const auto* node = root_.at_path(prefix).node();
    if (node == nullptr) return;
    if (!node->is_table())
      throw InputError("'" + prefix + "' must be a table", text(*node), "numbers by name",
                       place(file_, node->source()));
    only(*node->as_table(), prefix + ".", known);
    for (const auto& [key, entry] : *node->as_table()) {
      const std::string full = prefix + "." + std::string(key.str());
      const double value = finite(entry, full);
      const bool poisson = key.str() == "poisson";
      if (poisson ? !(value > -1 && value < 0.5) : !(value > 0))
        throw InputError("'" + full + "' makes no sense", text(entry),
                         poisson ? "a number between -1 and 0.5" : "a number > 0 (cgs)",
                         place(file_, entry.source()));
      all.push_back({full, value, static_cast<int>(entry.source().begin.line)});
    }
  }

private:
  const toml::node& member(const toml::table& table, const std::string& prefix,
                           const std::string& key) const {
    const auto* node = table.get(key);
    if (!node)
      throw InputError("a key is missing in the pump profile", "no '" + prefix + key + "'",
                       "'" + prefix + key + "'", place(file_, table.source()));
    return *node;
  }

  double finite(const toml::node& node, const std::string& key) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value))
      throw InputError("'" + key + "' needs numbers", text(node), "finite numbers, lengths in cm",
                       place(file_, node.source()));
    return *value;
  }

  std::filesystem::path file_;
  toml::table root_;
};

} // namespace

PumpProfile read_pump_profile(const std::filesystem::path& file) {
  const Reader reader(file);
  reader.only(reader.root(), "",
              {"housing", "stator", "membrane", "magnet", "materials", "operating_point", "published"});
  PumpProfile profile;
  profile.file = file;

  const auto& housing = reader.table("housing");
  reader.only(housing, "housing.", {"profile"});
  profile.housing = reader.pairs(housing, "housing.", "profile");

  const auto& stator = reader.table("stator");
  reader.only(stator, "stator.", {"profile"});
  profile.stator = reader.pairs(stator, "stator.", "profile");

  const auto& membrane = reader.table("membrane");
  reader.only(
      membrane, "membrane.",
      {"inner_radius", "outer_radius", "clamp_radius", "thickness", "mid_plane", "tip_radius", "rim_radius"});
  profile.membrane.inner_radius = reader.number(membrane, "membrane.", "inner_radius");
  profile.membrane.outer_radius = reader.number(membrane, "membrane.", "outer_radius");
  profile.membrane.clamp_radius = reader.number(membrane, "membrane.", "clamp_radius");
  profile.membrane.mid_plane = reader.number(membrane, "membrane.", "mid_plane");
  if (membrane.contains("tip_radius"))
    profile.membrane.tip_radius = reader.number(membrane, "membrane.", "tip_radius");
  if (membrane.contains("rim_radius"))
    profile.membrane.rim_radius = reader.number(membrane, "membrane.", "rim_radius");
  profile.membrane.thickness = reader.pairs(membrane, "membrane.", "thickness");
  profile.membrane.line = static_cast<int>(membrane.source().begin.line);

  const auto& magnet = reader.table("magnet");
  reader.only(magnet, "magnet.", {"polygon"});
  profile.magnet = reader.pairs(magnet, "magnet.", "polygon");

  if (const auto* node = reader.root().get("materials")) {
    const auto& table = reader.table("materials");
    reader.only(table, "materials.", {"fluid", "membrane", "magnet"});
    reader.only_numbers(*node, "materials");
    reader.materials("fluid", {"density", "viscosity"}, profile.materials);
    reader.materials("membrane", {"density", "young", "poisson"}, profile.materials);
    reader.materials("magnet", {"density", "young", "poisson"}, profile.materials);
  }
  for (const char* name : {"operating_point", "published"})
    if (const auto* node = reader.root().get(name)) reader.only_numbers(*node, name);

  check_pump_profile(profile);
  return profile;
}

double membrane_thickness(const MembraneProfile& membrane, double r) {
  const auto& table = membrane.thickness.points;
  if (r <= table.front().x()) return table.front().y();
  for (std::size_t i = 1; i < table.size(); ++i)
    if (r <= table[i].x()) {
      const double s = (r - table[i - 1].x()) / (table[i].x() - table[i - 1].x());
      return (1 - s) * table[i - 1].y() + s * table[i].y();
    }
  return table.back().y();
}

FluidOutline fluid_outline(const PumpProfile& profile) {
  FluidOutline outline;
  const auto line = [](const ProfileCurve& curve, std::size_t i) {
    return curve.lines.empty() ? 0 : curve.lines[i];
  };
  const auto add = [&](const Point<2>& point, FluidOutline::Curve curve, int at) {
    outline.points.push_back(point);
    outline.curves.push_back(curve);
    outline.lines.push_back(at);
  };
  const auto& housing = profile.housing;
  const auto& stator = profile.stator;
  const std::size_t rim = housing.points.size() - 1;
  const std::size_t nose = stator.points.size() - 1;

  add({0, housing.points.front().y()}, FluidOutline::axis, line(housing, 0));
  for (std::size_t i = 0; i < nose; ++i) add(stator.points[i], FluidOutline::stator, line(stator, i));
  add(stator.points[nose], FluidOutline::axis, line(stator, nose));
  add({0, housing.points.back().y()}, FluidOutline::outlet, line(housing, rim));
  for (std::size_t i = rim; i > 0; --i) add(housing.points[i], FluidOutline::housing, line(housing, i));
  add(housing.points.front(), FluidOutline::inlet, line(housing, 0));
  return outline;
}

} // namespace undula::geometry
