#include "fom/scene/entry_table.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double cm_per_mm = units::cm_per_mm;
constexpr bool shapes_state = true;
constexpr bool leaves_state = false;

AllowedRange from_to(double low, double high) { return {low, high, false, false}; }
AllowedRange above_to(double low, double high) { return {low, high, true, false}; }
AllowedRange between(double low, double high) { return {low, high, true, true}; }

/// One of a few names, kept in an enumeration that `field` gives.
template <typename Field, typename Enum>
ChoiceKey choice(Field field, std::vector<std::pair<const char*, Enum>> available, std::string fallback) {
  ChoiceKey key;
  key.get = [field](Scene& scene) { return static_cast<int>(field(scene)); };
  key.set = [field](Scene& scene, int value) { field(scene) = static_cast<Enum>(value); };
  for (const auto& [text, value] : available) {
    key.available.emplace_back(text, static_cast<int>(value));
  }
  key.fallback = std::move(fallback);
  return key;
}

// A function that returns a reference to a member of the entry that `entry` finds in a scene.
#define FIELD(member) [entry](Scene& scene) -> decltype(auto) { return (entry(scene).member); }

template <typename Entry>
void add_shape_keys(std::vector<SceneKey>& keys, Entry entry) {
  keys.push_back({"outline_mm", "mm", "corners, in either direction", shapes_state,
                  PositionListKey{FIELD(shape.outline), cm_per_mm}});
  keys.push_back(
      {"centre_mm", "mm", "centre of a circle", shapes_state, PositionKey{FIELD(shape.centre), cm_per_mm}});
  keys.push_back({"radius_mm", "mm",
                  "radius of a circle, in place of `outline_mm`; about a point of the axis of axisymmetric "
                  "space, of a sphere",
                  shapes_state, RealKey{FIELD(shape.radius), cm_per_mm, from_to(0, 1e6), 0.0}});
}

template <typename Entry>
std::vector<SceneKey> hole_keys(Entry entry) {
  std::vector<SceneKey> keys;
  add_shape_keys(keys, entry);
  return keys;
}

template <typename Entry>
std::vector<SceneKey> boundary_keys(Entry entry) {
  using Kind = BoundaryStatement::Kind;
  using Stress = BoundaryStatement::Stress;
  using Tangential = BoundaryStatement::Tangential;
  return {
      {"kind", "",
       "condition; `symmetry`: no flow through a side along a coordinate axis (the axis of axisymmetric "
       "space "
       "among them); `opening`: the stress is prescribed",
       shapes_state,
       choice<>(FIELD(kind),
                std::vector<std::pair<const char*, Kind>>{{"wall", Kind::wall},
                                                          {"velocity", Kind::velocity},
                                                          {"symmetry", Kind::symmetry},
                                                          {"opening", Kind::opening}},
                "wall")},
      {"velocity_cm_per_s", "cm_per_s", "with `kind = \"velocity\"`", shapes_state,
       ExpressionPairKey{FIELD(velocity)}},
      {"pressure_mmHg", "mmHg", "with `kind = \"opening\"`, a function of time alone", shapes_state,
       ExpressionKey{FIELD(pressure), ""}},
      {"stress", "",
       "of an opening; `static-pressure` leaves the dynamic term out on outflow; `traction`: plain normal "
       "stress",
       shapes_state,
       choice<>(FIELD(stress),
                std::vector<std::pair<const char*, Stress>>{{"total-pressure", Stress::total_pressure},
                                                            {"static-pressure", Stress::static_pressure},
                                                            {"traction", Stress::traction}},
                "total-pressure")},
      {"tangential", "", "velocity along an opening; `zero` needs a side along a coordinate axis",
       shapes_state,
       choice<>(FIELD(tangential),
                std::vector<std::pair<const char*, Tangential>>{{"zero", Tangential::zero},
                                                                {"free", Tangential::free}},
                "zero")},
      {"size_mm", "mm", "element size of the fluid at this boundary; 0: no demand", shapes_state,
       RealKey{FIELD(size), cm_per_mm, from_to(0, 1e6), 0.0}},
  };
}

template <typename Entry>
std::vector<SceneKey> body_keys(Entry entry) {
  using Law = BodyStatement::Law;
  std::vector<SceneKey> keys;
  add_shape_keys(keys, entry);
  const std::vector<SceneKey> others = {
      {"inner_radius_mm", "mm", "> 0: an annulus in place of a circle", shapes_state,
       RealKey{FIELD(shape.inner_radius), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"line_mm", "mm", "corners of a line inside that the mesh keeps as edges", shapes_state,
       PositionListKey{FIELD(line), cm_per_mm}},
      {"size_mm", "mm", "element size of the body's own mesh", shapes_state,
       RealKey{FIELD(size), cm_per_mm, above_to(0, 1e6), {}}},
      {"fluid_size_mm", "mm", "element size of the fluid at the body's skin; 0: no demand", shapes_state,
       RealKey{FIELD(fluid_size), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"law", "", "constitutive law, as `model.solid`", shapes_state,
       choice<>(
           FIELD(law),
           std::vector<std::pair<const char*, Law>>{{"linear", Law::linear},
                                                    {"saint-venant-kirchhoff", Law::saint_venant_kirchhoff},
                                                    {"neo-hookean", Law::neo_hookean}},
           "linear")},
      {"density_g_per_cm3", "g_per_cm3", "0 only where the whole body is held", shapes_state,
       RealKey{FIELD(density), 1, from_to(0, 1e6), 0.0}},
      {"young_dyn_per_cm2", "dyn_per_cm2", "Young's modulus; 0 only where the whole body is held",
       shapes_state, RealKey{FIELD(young), 1, from_to(0, 1e14), 0.0}},
      {"poisson", "", "Poisson's ratio", shapes_state, RealKey{FIELD(poisson), 1, between(-1, 0.5), 0.3}},
      {"damping_time_s", "s", "Kelvin-Voigt damping, as `membrane.damping_time_s`", shapes_state,
       RealKey{FIELD(damping_time), 1, from_to(0, 1), 0.0}},
      {"mass_damping_per_s", "per_s", "Rayleigh damping", shapes_state,
       RealKey{FIELD(mass_damping), 1, from_to(0, 1e6), 0.0}},
      {"stiffness_damping_s", "s", "Rayleigh damping", shapes_state,
       RealKey{FIELD(stiffness_damping), 1, from_to(0, 1), 0.0}},
      {"held", "",
       "the displacement is imposed at rest positions where this is not 0, for instance `x < 10`; left out: "
       "nowhere; `1`: everywhere",
       shapes_state, ExpressionKey{FIELD(held), ""}},
      {"displacement_mm", "mm", "imposed where `held`; left out: 0", shapes_state,
       ExpressionPairKey{FIELD(displacement)}},
      {"body_force_dyn_per_cm3", "dyn_per_cm3", "force per volume at rest", shapes_state,
       ExpressionPairKey{FIELD(body_force)}},
      {"velocity_cm_per_s", "cm_per_s", "at t = 0; left out: at rest", shapes_state,
       ExpressionPairKey{FIELD(velocity)}},
  };
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

template <typename Entry>
std::vector<SceneKey> refinement_keys(Entry entry) {
  return {
      {"body", "", "name of the body whose elements they are, of general scenes; left out: the fluid's",
       shapes_state, NameKey{FIELD(body)}},
      {"box_mm", "mm", "lowest and highest corner", shapes_state, PositionListKey{FIELD(box), cm_per_mm}},
      {"size_mm", "mm", "element size in the box", shapes_state,
       RealKey{FIELD(size), cm_per_mm, above_to(0, 1e6), {}}},
  };
}

template <typename Entry>
std::vector<SceneKey> load_keys(Entry entry) {
  return {
      {"on", "", "name of the body", shapes_state, NameKey{FIELD(on)}},
      {"where", "", "the load acts at rest positions where this is not 0; left out: on all of the skin",
       shapes_state, ExpressionKey{FIELD(where), ""}},
      {"pressure_mmHg", "mmHg", "by rest position and time; pushes on the displaced skin along its normal",
       shapes_state, ExpressionKey{FIELD(pressure), ""}},
      {"traction_dyn_per_cm2", "dyn_per_cm2",
       "force per area at rest, by rest position and time; keeps its direction", shapes_state,
       ExpressionPairKey{FIELD(traction)}},
  };
}

template <typename Entry>
std::vector<SceneKey> rigid_keys(Entry entry) {
  std::vector<SceneKey> keys;
  add_shape_keys(keys, entry);
  const std::vector<SceneKey> others = {
      {"line_mm", "mm",
       "two points, in place of a shape: all that lies on the right of the way from the first to the second",
       shapes_state, PositionListKey{FIELD(line), cm_per_mm}},
      {"material", "", "of a circle, where it is rigid; `outside`: a round bore", shapes_state,
       choice<>(FIELD(hollow),
                std::vector<std::pair<const char*, bool>>{{"inside", false}, {"outside", true}}, "inside")},
      {"displacement_mm", "mm", "of time alone; left out: none. In axisymmetric space along z alone",
       shapes_state, ExpressionPairKey{FIELD(displacement)}},
      {"angle_deg", "deg", "it is turned by, counter-clockwise, of time alone; plane space", shapes_state,
       ExpressionKey{FIELD(angle), ""}},
      {"about_mm", "mm",
       "one point, [[0.0, 0.0]], that it turns about before it is displaced; left out: the centre of the "
       "circle, or the origin",
       shapes_state, PositionListKey{FIELD(about), cm_per_mm}},
  };
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

template <typename Entry>
std::vector<SceneKey> pair_keys(Entry entry) {
  return {
      {"between", "",
       "two names: a body, and another body, a rigid body or the same body again (its skin may touch itself)",
       shapes_state, NameListKey{FIELD(between)}},
      {"film_mm", "mm", "distance that is kept between the skins", shapes_state,
       RealKey{FIELD(film), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"stiffness_dyn_per_cm3", "dyn_per_cm3",
       "pressure per depth in the film, per area at rest; 0: 10 times Young's modulus over the element size, "
       "of "
       "the stiffer body",
       shapes_state, RealKey{FIELD(stiffness), 1, from_to(0, 1e30), 0.0}},
      {"deepest_mm", "mm",
       "a step that ends deeper in the film fails; 0: half of the film, or a tenth of an element without one",
       shapes_state, RealKey{FIELD(deepest), cm_per_mm, from_to(0, 1e6), 0.0}},
      {"friction", "", "Coulomb's coefficient", shapes_state,
       RealKey{FIELD(friction), 1, from_to(0, 100), 0.0}},
      {"creep_cm_per_s", "cm_per_s",
       "slip speed at which friction reaches 0.71 of its limit; needed with friction", shapes_state,
       RealKey{FIELD(creep), 1, from_to(0, 1e6), 0.0}},
  };
}

template <typename Entry>
std::vector<SceneKey> point_keys(Entry entry) {
  return {
      {"body", "",
       "name of the body whose displacement is followed; left out: pressure and velocity of the fluid",
       leaves_state, NameKey{FIELD(body)}},
      {"at_mm", "mm", "position, of a body at rest", leaves_state, PositionKey{FIELD(at), cm_per_mm}},
  };
}

template <typename Entry>
std::vector<SceneKey> force_keys(Entry entry) {
  return {{"on", "", "names of bodies, and of boundaries with an imposed velocity, whose forces are added",
           leaves_state, NameListKey{FIELD(on)}}};
}

#undef FIELD

/// Calls `use` with the map of entries of a kind.
template <typename ProblemType, typename Use>
void with_entries(ProblemType& problem, std::string_view kind, const Use& use) {
  if (kind == "hole") use(problem.holes);
  if (kind == "boundary") use(problem.boundaries);
  if (kind == "body") use(problem.bodies);
  if (kind == "refine") use(problem.refinements);
  if (kind == "load") use(problem.loads);
  if (kind == "rigid") use(problem.rigid);
  if (kind == "pair") use(problem.pairs);
  if (kind == "point") use(problem.points);
  if (kind == "force") use(problem.forces);
}

std::vector<SceneKey> make_keys(const std::string& kind, const std::string& name) {
  std::vector<SceneKey> keys;
  if (kind == "hole")
    keys = hole_keys([name](Scene & scene) -> auto& { return scene.problem.holes.at(name); });
  else if (kind == "boundary")
    keys = boundary_keys([name](Scene & scene) -> auto& { return scene.problem.boundaries.at(name); });
  else if (kind == "body")
    keys = body_keys([name](Scene & scene) -> auto& { return scene.problem.bodies.at(name); });
  else if (kind == "refine")
    keys = refinement_keys([name](Scene & scene) -> auto& { return scene.problem.refinements.at(name); });
  else if (kind == "load")
    keys = load_keys([name](Scene & scene) -> auto& { return scene.problem.loads.at(name); });
  else if (kind == "rigid")
    keys = rigid_keys([name](Scene & scene) -> auto& { return scene.problem.rigid.at(name); });
  else if (kind == "pair")
    keys = pair_keys([name](Scene & scene) -> auto& { return scene.problem.pairs.at(name); });
  else if (kind == "point")
    keys = point_keys([name](Scene & scene) -> auto& { return scene.problem.points.at(name); });
  else if (kind == "force")
    keys = force_keys([name](Scene & scene) -> auto& { return scene.problem.forces.at(name); });
  else if (kind == constants_section)
    keys = {{"", "", "constant of expressions", shapes_state,
             RealKey{[name](Scene& scene) -> double& { return scene.problem.constants.at(name); },
                     1,
                     from_to(-1e300, 1e300),
                     {}}}};
  for (SceneKey& key : keys) {
    key.path = kind + "." + name + (key.path.empty() ? "" : "." + key.path);
    const EntryKind* known = find_entry_kind(kind);
    key.scope = known != nullptr ? known->scope : Scope::general;
  }
  return keys;
}

} // namespace

std::span<const EntryKind> entry_kinds() {
  static const std::array<EntryKind, 9> kinds = {{
      {"boundary",
       "Conditions on a side of the domain or the edge of a hole. Those without a section are walls at "
       "rest."},
      {"hole", "Holes of the domain; the edge of a hole is the boundary of its name."},
      {"body",
       "Solids with meshes of their own, which the fluid's mesh need not know. They may reach out of the "
       "domain "
       "or into a hole: only what lies in the fluid counts there."},
      {"refine",
       "Boxes in which elements are small, in scenes with a domain, bodies or a pump's profile. `--set "
       "refine.NAME.box_mm=...` adds one.",
       Scope::any, true},
      {"load", "Loads on the skin of a body, for instance a pressure on a dry side."},
      {"rigid", "Rigid bodies that bodies may touch; how they move is stated. They displace no fluid."},
      {"pair",
       "What may touch: columns NAME_load_..., NAME_force_... (on the first), NAME_pressure_max_..., "
       "NAME_length_mm, "
       "NAME_penetration_mm, NAME_power_..., NAME_friction_power_..."},
      {"point",
       "Points that are followed: columns NAME_displacement_... of a body, NAME_pressure_mmHg and "
       "NAME_velocity_... of the fluid."},
      {"force",
       "Forces of the fluid, by the residual of the discrete equations: columns NAME_force_x_N_per_m (plane, "
       "per "
       "depth) or NAME_force_z_mN (axisymmetric)."},
  }};
  return kinds;
}

const EntryKind* find_entry_kind(std::string_view name) {
  const auto kinds = entry_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const EntryKind& kind) { return kind.kind == name; });
  return found == kinds.end() ? nullptr : &*found;
}

std::span<const SceneKey> entry_keys(const std::string& kind, const std::string& name) {
  // Made once per entry, so that keys can be named by pointers as those of the table.
  static std::map<std::pair<std::string, std::string>, std::vector<SceneKey>> made;
  const auto [place, added] = made.try_emplace({kind, name});
  if (added) {
    place->second = make_keys(kind, name);
  }
  return place->second;
}

EntryName entry_of(std::string_view path) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) {
    return {};
  }
  const std::string_view kind = path.substr(0, dot);
  const auto rest = path.substr(dot + 1);
  if (find_entry_kind(kind) != nullptr) {
    return {std::string(kind), std::string(rest.substr(0, rest.find('.')))};
  }
  return kind == constants_section ? EntryName{std::string(kind), std::string(rest)} : EntryName{};
}

std::vector<std::string> entry_names(const Scene& scene, const std::string& kind) {
  std::vector<std::string> names;
  const auto collect = [&](const auto& entries) {
    for (const auto& [name, entry] : entries) {
      names.push_back(name);
    }
  };
  with_entries(scene.problem, kind, collect);
  if (kind == constants_section) {
    collect(scene.problem.constants);
  }
  return names;
}

void check_entry_exists(const Scene& scene, std::string_view path, const std::string& where) {
  const EntryName entry = entry_of(path);
  if (!entry) {
    return;
  }
  std::string known;
  for (const std::string& name : entry_names(scene, entry.kind)) {
    if (name == entry.name) {
      return;
    }
    known += (known.empty() ? "" : ", ") + entry.kind + "." + name;
  }
  throw InputError("the scene has no such entry", '"' + entry.kind + "." + entry.name + '"',
                   known.empty() ? "none: there is no [" + entry.kind + "] in the scene" : known, where);
}

void add_entry(Scene& scene, const std::string& kind, const std::string& name) {
  with_entries(scene.problem, kind, [&](auto& entries) { entries.try_emplace(name); });
  if (kind == constants_section) {
    scene.problem.constants.try_emplace(name, 0.0);
  }
}

bool is_of_fluid(std::string_view path) {
  return path.starts_with("fluid.") || path.starts_with("stabilisation.");
}

std::vector<SceneKey> keys_of(const Scene& scene) {
  const bool in_vacuo = scene.problem.general && !has_fluid(scene.problem.domain);
  std::vector<SceneKey> keys;
  for (const SceneKey& key : scene_table()) {
    const bool of_no_fluid = in_vacuo && is_of_fluid(key.path);
    const bool left_out = scene.operating_point.drive == Drive::voltage &&
                          key.path == "operating_point.stroke_mm" && !scene.places.contains(key.path);
    if (key.applies_to(scene) && !of_no_fluid && !left_out) {
      keys.push_back(key);
    }
  }
  const auto add = [&](const std::string& kind) {
    for (const std::string& name : entry_names(scene, kind)) {
      const auto more = entry_keys(kind, name);
      keys.insert(keys.end(), more.begin(), more.end());
    }
  };
  add(constants_section);
  for (const EntryKind& kind : entry_kinds()) {
    add(kind.kind);
  }
  return keys;
}

} // namespace undula::fom
