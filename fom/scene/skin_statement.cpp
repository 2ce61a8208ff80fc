#include "fom/scene/skin_statement.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include "fom/contact/rigid_gap.hpp"
#include "fom/scene/key_place.hpp"
#include "fom/scene/scene_functions.hpp"
#include "fom/scene/shape_outline.hpp"
#include "geometry/mesh/outline_faults.hpp"
#include "geometry/mesh/polygons.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

constexpr double stiffness_per_modulus = 10; ///< times the modulus over the element size
constexpr double deepest_of_film = 0.5, deepest_of_element = 0.1;

std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

class SkinChecker {
public:
  SkinChecker(const Scene& scene, const std::string& where)
      : scene_(scene), problem_(scene.problem), where_(where), functions_(scene) {}

  void run() const {
    for (const auto& [name, load] : problem_.loads) check_load(name, load);
    for (const auto& [name, rigid] : problem_.rigid) check_rigid(name, rigid);
    for (const auto& [name, pair] : problem_.pairs) check_pair(name, pair);
  }

private:
  std::string at(const std::string& path) const { return place_of_key(scene_, path, where_); }

  std::string bodies() const {
    std::string names;
    for (const auto& [name, body] : problem_.bodies) names += (names.empty() ? "" : ", ") + in_quotes(name);
    return names.empty() ? "a body; there is none" : names;
  }

  void check_load(const std::string& name, const LoadStatement& load) const {
    const std::string entry = "load." + name;
    if (!problem_.bodies.contains(load.on))
      throw InputError("a load acts on an unknown body", in_quotes(load.on), bodies(), at(entry + ".on"));
    if (load.pressure.empty() && load.traction[0].empty())
      throw InputError("a load has no size", "neither \"pressure_mmHg\" nor \"traction_dyn_per_cm2\"",
                       "at least one of them", where_ + ", section [" + entry + "]");
    (void)functions_.region(load.where, at(entry + ".where"));
    (void)functions_.scalar(load.pressure, 1, at(entry + ".pressure_mmHg"));
    (void)functions_.vector(load.traction, 1, at(entry + ".traction_dyn_per_cm2"));
  }

  void check_rigid(const std::string& name, const RigidStatement& rigid) const {
    const std::string entry = "rigid." + name;
    const int ways = (rigid.shape.outline.empty() ? 0 : 1) + (rigid.shape.radius > 0 ? 1 : 0) +
                     (rigid.line.empty() ? 0 : 1);
    if (ways != 1)
      throw InputError("a rigid body is not stated in exactly one way", std::to_string(ways) + " shapes",
                       "one of \"radius_mm\" with \"centre_mm\", \"outline_mm\", \"line_mm\"",
                       where_ + ", section [" + entry + "]");
    if (problem_.bodies.contains(name))
      throw InputError("a body and a rigid body share a name", in_quotes(name), "names of their own",
                       where_ + ", section [" + entry + "]");
    if (!rigid.line.empty() && (rigid.line.size() != 2 || rigid.line[0] == rigid.line[1]))
      throw InputError("a line does not bound a half-plane", std::to_string(rigid.line.size()) + " points",
                       "two different points", at(entry + ".line_mm"));
    if (rigid.hollow && rigid.shape.radius == 0)
      throw InputError("only a circle can be rigid outside", "material = \"outside\"",
                       "material = \"inside\", or \"radius_mm\"", at(entry + ".material"));
    if (rigid.about.size() > 1)
      throw InputError("a rigid body turns about more than one point",
                       std::to_string(rigid.about.size()) + " points", "one", at(entry + ".about_mm"));
    if (!rigid.shape.outline.empty()) {
      const auto corners = corners_of(rigid.shape, 1);
      if (corners.size() < 3 || outline_fault(corners, narrowest_part * largest_extent(corners)))
        throw InputError("the outline of a rigid body is none",
                         std::to_string(corners.size()) + " corners, too few, crossing, repeated or too near",
                         "3 or more corners in order around the shape", at(entry + ".outline_mm"));
    }
    if (scene_.space == Space::axisymmetric) check_ring(entry, rigid);
    const bool used =
        std::any_of(problem_.pairs.begin(), problem_.pairs.end(), [&, &name = name](const auto& pair) {
          return std::count(pair.second.between.begin(), pair.second.between.end(), name) > 0;
        });
    if (!used)
      throw InputError("nothing may touch a rigid body", in_quotes(name),
                       "a [pair.NAME] with it in \"between\"", where_ + ", section [" + entry + "]");
    check_motion(entry, rigid);
  }

  void check_ring(const std::string& entry, const RigidStatement& rigid) const {
    if (!rigid.angle.empty())
      throw InputError("a ring cannot turn in its meridian", "\"angle_deg\"",
                       "no such key in axisymmetric space", at(entry + ".angle_deg"));
    const double radius = rigid.shape.radius, centre = rigid.shape.centre[0];
    if (radius > 0 && centre != 0 && centre < radius)
      throw InputError("a rigid circle reaches over the axis to negative radii",
                       exact_number(units::length_to_mm(centre)) + " mm from the axis",
                       "a centre at r = 0, for a ball, or at r >= radius_mm", at(entry + ".centre_mm"));
  }

  void check_motion(const std::string& entry, const RigidStatement& rigid) const {
    const auto angle = functions_.time(rigid.angle, 1, at(entry + ".angle_deg"));
    const auto displacement = functions_.vector(rigid.displacement, 1, at(entry + ".displacement_mm"));
    constexpr int samples = 8;
    for (int k = 0; k <= samples; ++k) {
      const double t = scene_.time.end * k / samples;
      try {
        if (angle) (void)angle(t);
        if (!displacement) continue;
        const double along_r = displacement(Point<2>::Zero(), t)[0];
        if (scene_.space == Space::axisymmetric && along_r != 0)
          throw InputError("a rigid ring would have to stretch",
                           in_quotes(rigid.displacement[0]) + " along r", "\"0\", and any motion along z",
                           at(entry + ".displacement_mm"));
      } catch (const NumericsError& error) {
        throw InputError("a motion has no finite value", error.what(),
                         "expressions that are finite at all times", where_ + ", section [" + entry + "]");
      }
    }
  }

  void check_pair(const std::string& name, const PairStatement& pair) const {
    const std::string entry = "pair." + name, between = at(entry + ".between");
    if (pair.between.size() != 2)
      throw InputError("a pair is not one", std::to_string(pair.between.size()) + " names",
                       "two names, for instance [\"tube\", \"roller\"]", between);
    if (!problem_.bodies.contains(pair.between[0]))
      throw InputError("a pair does not begin with a body", in_quotes(pair.between[0]), bodies(), between);
    if (!problem_.bodies.contains(pair.between[1]) && !problem_.rigid.contains(pair.between[1]))
      throw InputError("a pair ends with something unknown", in_quotes(pair.between[1]),
                       bodies() + ", or a [rigid.NAME]", between);
    for (const auto& [other_name, other] : problem_.pairs) {
      if (other_name == name) break;
      auto a = pair.between, b = other.between;
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      if (a == b)
        throw InputError("two pairs are between the same bodies",
                         in_quotes(name) + " and " + in_quotes(other_name), "one pair", between);
    }
    if (pair.friction > 0 && pair.creep == 0)
      throw InputError("friction needs a speed of creep", "\"friction\" without \"creep_cm_per_s\"",
                       "\"creep_cm_per_s\" > 0, small against the slip that counts", at(entry + ".friction"));
    if (pair.stiffness == 0 && !has_modulus(pair))
      throw InputError("nothing says how stiff a pair is", "no body of it with \"young_dyn_per_cm2\" > 0",
                       "\"stiffness_dyn_per_cm3\" > 0", where_ + ", section [" + entry + "]");
  }

  bool has_modulus(const PairStatement& pair) const {
    return std::any_of(pair.between.begin(), pair.between.end(), [&](const std::string& name) {
      const auto body = problem_.bodies.find(name);
      return body != problem_.bodies.end() && body->second.young > 0;
    });
  }

  const Scene& scene_;
  const ProblemStatement& problem_;
  const std::string& where_;
  SceneFunctions functions_;
};

RigidBody<2> rigid_of(const std::string& name, const RigidStatement& statement,
                      const SceneFunctions& functions, const std::string& where) {
  using Shape = RigidBody<2>::Shape;
  RigidBody<2> body;
  body.name = name;
  body.centre = point_of(statement.shape.centre);
  body.radius = statement.shape.radius;
  body.hollow = statement.hollow;
  if (!statement.line.empty()) {
    body.shape = Shape::half_space;
    body.centre = point_of(statement.line[0]);
    const Point<2> along = (point_of(statement.line[1]) - body.centre).normalized();
    body.normal = {-along[1], along[0]};
  } else if (!statement.shape.outline.empty()) {
    body.shape = Shape::polygon;
    body.outline = corners_of(statement.shape, 1);
    if (polygon_area(body.outline) < 0) std::reverse(body.outline.begin(), body.outline.end());
  }
  if (!statement.about.empty())
    body.about = point_of(statement.about.front());
  else if (body.radius > 0)
    body.about = body.centre;
  const auto motion =
      functions.vector(statement.displacement, units::cm_per_mm, where + " \"displacement_mm\"");
  if (motion) body.displacement = [motion](double t) { return motion(Point<2>::Zero(), t); };
  body.angle = functions.time(statement.angle, std::numbers::pi / 180, where + " \"angle_deg\"");
  return body;
}

/// Refuses a body that lies in a rigid one before anything moves.
void check_start(const FsiProblem<2>& problem, const ContactPair& pair, double dt, const std::string& where) {
  if (pair.rigid < 0) return;
  const auto& rigid = problem.rigid[static_cast<std::size_t>(pair.rigid)];
  const auto& mesh = problem.solids[static_cast<std::size_t>(pair.solid)].mesh;
  const auto placement = place_rigid<2>(rigid, 0, dt);
  for (const auto& facet : mesh.boundary)
    for (const int point : facet.points) {
      const Point<2>& x = mesh.points[static_cast<std::size_t>(point)];
      const double gap = gap_to_rigid<2>(rigid, placement, x).distance;
      if (gap < pair.film - pair.deepest)
        throw InputError(
            "a body lies in a rigid body at the start",
            "(" + plain_number(units::length_to_mm(x[0])) + ", " + plain_number(units::length_to_mm(x[1])) +
                ") mm lies " + plain_number(units::length_to_mm(-gap)) + " mm inside of [rigid." +
                rigid.name + "]",
            "bodies that touch at most, nearer than \"film_mm\" by \"deepest_mm\" at most", where);
    }
}

} // namespace

double smallest_size(const ProblemStatement& problem, const std::string& body) {
  double size = problem.bodies.at(body).size;
  for (const auto& [name, box] : problem.refinements)
    if (box.body == body) size = std::min(size, box.size);
  return size;
}

void check_skin_statement(const Scene& scene, const std::string& where) { SkinChecker(scene, where).run(); }

void add_skin_conditions(const Scene& scene, FsiProblem<2>& problem) {
  const auto& statement = scene.problem;
  const SceneFunctions functions(scene);
  const auto solid_named = [&](const std::string& name) {
    const auto found = std::find_if(problem.solids.begin(), problem.solids.end(),
                                    [&](const auto& solid) { return solid.name == name; });
    return found == problem.solids.end() ? -1 : static_cast<int>(found - problem.solids.begin());
  };
  const auto section = [&](const std::string& entry) {
    return scene.file.string() + ", section [" + entry + "]";
  };
  for (const auto& [name, load] : statement.loads) {
    const std::string where = section("load." + name);
    auto& added = problem.loads.emplace_back();
    added.solid = solid_named(load.on);
    added.where = functions.region(load.where, where + " \"where\"");
    added.pressure =
        functions.scalar(load.pressure, units::dyn_per_cm2_per_mmHg, where + " \"pressure_mmHg\"");
    added.traction = functions.vector(load.traction, 1, where + " \"traction_dyn_per_cm2\"");
  }
  for (const auto& [name, rigid] : statement.rigid)
    problem.rigid.push_back(rigid_of(name, rigid, functions, section("rigid." + name)));
  for (const auto& [name, pair] : statement.pairs) {
    ContactPair added;
    added.name = name;
    added.solid = solid_named(pair.between[0]);
    added.other_solid = solid_named(pair.between[1]);
    for (std::size_t r = 0; r < problem.rigid.size(); ++r)
      if (problem.rigid[r].name == pair.between[1]) added.rigid = static_cast<int>(r);
    added.film = pair.film;
    added.friction = pair.friction;
    added.creep = pair.creep;
    double stiffest = 0, smallest = smallest_size(statement, pair.between[0]);
    for (const auto& body : pair.between) {
      if (!statement.bodies.contains(body)) continue;
      const double size = smallest_size(statement, body);
      stiffest = std::max(stiffest, statement.bodies.at(body).young / size);
      smallest = std::min(smallest, size);
    }
    added.stiffness = pair.stiffness > 0 ? pair.stiffness : stiffness_per_modulus * stiffest;
    added.deepest = pair.deepest > 0 ? pair.deepest
                    : pair.film > 0  ? deepest_of_film * pair.film
                                     : deepest_of_element * smallest;
    check_start(problem, added, scene.time.step, section("pair." + name));
    problem.pairs.push_back(added);
  }
}

} // namespace undula::fom
