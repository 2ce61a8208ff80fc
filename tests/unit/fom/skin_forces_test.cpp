// Loads and contact on skins: forces are what differences of energies and of forces say.
#include "fom/contact/skin_forces.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "fom/scene/general_problem.hpp"
#include "fom/scene/scene_file.hpp"

namespace undula::fom {
namespace {

/// Two discs (in axisymmetric space rings) that overlap a little once displaced, the upper one in contact
/// with a rigid body of the scene.
Discretisation<2> two_discs(const std::string& space, const std::string& more) {
  const std::string text = "name = \"discs\"\n[model]\nspace = \"" + space + R"("
[body.lower]
centre_mm = [3, 0]
radius_mm = 1.5
size_mm = 1.1
density_g_per_cm3 = 1
young_dyn_per_cm2 = 1e5
[body.upper]
centre_mm = [3.1, 3.1]
radius_mm = 1.6
size_mm = 0.9
density_g_per_cm3 = 1
young_dyn_per_cm2 = 1e5
[time]
step_s = 0.1
end_s = 1.0
)" + more;
  return discretise(general_problem(parse_scene(text, "discs", ".")), CutOptions{});
}

/// Random displacements (cm), the upper block pushed down by `depth`.
Eigen::VectorXd displaced_by(const Discretisation<2>& disc, double noise, double depth) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-noise, noise);
  Eigen::VectorXd d(disc.unknowns());
  for (auto& value : d) value = part(random);
  for (int u = disc.solid_offset[1] + 1; u < disc.solid_offset[2]; u += 2) d[u] -= depth;
  return d;
}

/// The largest difference between the stiffness and central differences of the force, over the largest entry.
double stiffness_error(const Discretisation<2>& disc, const Eigen::VectorXd& d, const Eigen::VectorXd& v,
                       double rate) {
  const auto forces = prepare_skin_forces(disc, 0.1);
  const auto at = [&](const Eigen::VectorXd& place, const Eigen::VectorXd& speed) -> Eigen::VectorXd {
    const auto response = skin_response<2>(forces, disc, {place, speed, 0.3, rate}, false);
    return response.loads + response.contact;
  };
  const Eigen::MatrixXd stiffness = skin_response<2>(forces, disc, {d, v, 0.3, rate}, true).stiffness;
  const double h = 1e-7;
  double worst = 0;
  for (int u = 0; u < disc.unknowns(); ++u) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(disc.unknowns());
    change[u] = h;
    const Eigen::VectorXd slope =
        (at(d + change, v + rate * change) - at(d - change, v - rate * change)) / (2 * h);
    worst = std::max(worst, (slope + stiffness.col(u)).lpNorm<Eigen::Infinity>());
  }
  EXPECT_GT(stiffness.lpNorm<Eigen::Infinity>(), 0);
  return worst / stiffness.lpNorm<Eigen::Infinity>();
}

/// The contact force against central differences of the stored energy, over the largest force.
double energy_error(const Discretisation<2>& disc, const Eigen::VectorXd& d) {
  const auto forces = prepare_skin_forces(disc, 0.1);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(disc.unknowns());
  const auto energy = [&](const Eigen::VectorXd& place) {
    return skin_response<2>(forces, disc, {place, still, 0.3, 0}, false).reports.front().energy;
  };
  const Eigen::VectorXd force = skin_response<2>(forces, disc, {d, still, 0.3, 0}, false).contact;
  const double h = 1e-6;
  double worst = 0;
  for (int u = 0; u < disc.unknowns(); ++u) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(disc.unknowns());
    change[u] = h;
    worst = std::max(worst, std::abs((energy(d + change) - energy(d - change)) / (2 * h) + force[u]));
  }
  EXPECT_GT(force.lpNorm<Eigen::Infinity>(), 0);
  return worst / force.lpNorm<Eigen::Infinity>();
}

const std::string rigid_circle = R"([rigid.roller]
centre_mm = [3.0, 6.75]
radius_mm = 2
displacement_mm = ["0", "-t/2"]
[pair.press]
between = ["upper", "roller"]
stiffness_dyn_per_cm3 = 1e7
)";
const std::string rigid_polygon = R"([rigid.wedge]
outline_mm = [[2.5, 4.6], [4.5, 5.5], [0.5, 5.5]]
displacement_mm = ["0", "-t/2"]
[pair.press]
between = ["upper", "wedge"]
stiffness_dyn_per_cm3 = 1e7
)";
const std::string skins = R"([pair.press]
between = ["upper", "lower"]
stiffness_dyn_per_cm3 = 1e7
)";

// Between two skins the pieces of the quadrature move with the nodes. Where the film ends inside of a piece
// the pressure has a kink there and the stiffness a jump, so differences see the error of the quadrature
// change.

TEST(SkinForces, ContactIsTheSlopeOfItsEnergy) {
  for (const std::string space : {"plane", "axisymmetric"})
    for (const auto& [pair, tolerance] :
         {std::pair(rigid_circle, 1e-4), {rigid_polygon, 1e-4}, {skins, 2e-3}}) {
      const auto disc = two_discs(space, pair);
      EXPECT_LT(energy_error(disc, displaced_by(disc, 1e-5, 6e-3)), tolerance) << space << "\n" << pair;
    }
}

TEST(SkinForces, TheStiffnessIsTheSlopeOfTheForce) {
  for (const std::string space : {"plane", "axisymmetric"})
    for (const auto& [pair, tolerance] : {std::pair(rigid_circle, 1e-3), {skins, 0.05}}) {
      const auto disc = two_discs(space, pair);
      const Eigen::VectorXd d = displaced_by(disc, 1e-5, 6e-3), v = Eigen::VectorXd::Zero(disc.unknowns());
      EXPECT_LT(stiffness_error(disc, d, v, 0), tolerance) << space << "\n" << pair;
    }
}

TEST(SkinForces, TheStiffnessOfLoadsIsTheSlopeOfTheForce) {
  const std::string load = R"toml([load.around]
on = "upper"
pressure_mmHg = "100*(1 + t)"
traction_dyn_per_cm2 = ["1e4", "2e4"]
)toml";
  for (const std::string space : {"plane", "axisymmetric"}) {
    const auto disc = two_discs(space, load);
    const Eigen::VectorXd d = displaced_by(disc, 5e-3, 0), v = Eigen::VectorXd::Zero(disc.unknowns());
    EXPECT_LT(stiffness_error(disc, d, v, 0), 1e-6) << space;
  }
}

TEST(SkinForces, TheStiffnessOfFrictionIsTheSlopeOfTheForceButForTurnsOfTheSkin) {
  const auto disc = two_discs("plane", skins + "friction = 0.4\ncreep_cm_per_s = 0.5\n");
  const Eigen::VectorXd d = displaced_by(disc, 1e-5, 6e-3);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(disc.unknowns());
  for (int u = disc.solid_offset[1]; u < disc.solid_offset[2]; u += 2) v[u] = 0.7;
  EXPECT_LT(stiffness_error(disc, d, v, 10), 0.06);
}

TEST(SkinForces, FrictionOnARigidBodyIsCoulombsAndGrowsWithThePressure) {
  const auto disc = two_discs("plane", rigid_circle + "friction = 0.4\ncreep_cm_per_s = 0.5\n");
  const Eigen::VectorXd d = displaced_by(disc, 0, 6e-3);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(disc.unknowns());
  for (int u = disc.solid_offset[1]; u < disc.solid_offset[2]; u += 2) v[u] = 20;
  EXPECT_LT(stiffness_error(disc, d, v, 10), 0.05);
  const auto report =
      skin_response<2>(prepare_skin_forces(disc, 0.1), disc, {d, v, 0.3, 10}, false).reports.front();
  EXPECT_NEAR(report.friction_power, 0.4 * report.load * 20, 0.01 * 0.4 * report.load * 20);
  EXPECT_LT(report.force[0], -0.35 * report.load); // against the slip
}

TEST(SkinForces, APressureAllAroundPushesNowhere) {
  const auto disc = two_discs("plane", "[load.around]\non = \"upper\"\npressure_mmHg = \"100\"\n");
  const auto forces = prepare_skin_forces(disc, 0.1);
  const Eigen::VectorXd d = displaced_by(disc, 5e-3, 0);
  const Eigen::VectorXd force = skin_response<2>(forces, disc, {d, d, 0, 0}, false).loads;
  double x = 0, y = 0;
  for (int u = disc.solid_offset[1]; u < disc.solid_offset[2]; u += 2) {
    x += force[u];
    y += force[u + 1];
  }
  EXPECT_GT(force.norm(), 1);
  EXPECT_NEAR(x, 0, 1e-10 * force.norm());
  EXPECT_NEAR(y, 0, 1e-10 * force.norm());
}

TEST(RigidGap, DerivativesAreDifferencesOfTheDistance) {
  RigidBody<2> ball, bore, polygon, half_space;
  ball.centre = bore.centre = {1, 2};
  ball.radius = bore.radius = 3;
  bore.hollow = true;
  polygon.shape = RigidBody<2>::Shape::polygon;
  polygon.outline = {{0, 0}, {3, 0}, {1, 2}};
  half_space.shape = RigidBody<2>::Shape::half_space;
  half_space.normal = {0.6, 0.8};
  for (auto* body : {&ball, &bore, &polygon, &half_space}) {
    body->displacement = [](double t) { return Point<2>(0.3 * t, -t * t); };
    body->angle = [](double t) { return 2 * t; };
    body->about = {0.5, 0.25};
    const auto placement = place_rigid<2>(*body, 0.4, 0.1);
    for (const Point<2>& x : {Point<2>(0.9, 0.4), Point<2>(4, 3), Point<2>(-2, 1), Point<2>(0.3, -0.8)}) {
      const auto gap = gap_to_rigid<2>(*body, placement, x);
      const double h = 1e-6;
      for (int c = 0; c < 2; ++c) {
        const Point<2> change = h * Point<2>::Unit(c);
        const auto more = gap_to_rigid<2>(*body, placement, x + change),
                   less = gap_to_rigid<2>(*body, placement, x - change);
        EXPECT_NEAR((more.distance - less.distance) / (2 * h), gap.direction[c], 1e-7);
        EXPECT_LT(((more.direction - less.direction) / (2 * h) - gap.second_derivative.col(c)).norm(), 1e-6);
      }
      // The material goes where the motion takes it: a place of it keeps its distance.
      const double dt = 1e-5;
      const auto later = gap_to_rigid<2>(*body, place_rigid<2>(*body, 0.4 + dt, 0.1), x + dt * gap.velocity);
      EXPECT_NEAR(later.distance, gap.distance, 1e-8);
    }
  }
}

} // namespace
} // namespace undula::fom
