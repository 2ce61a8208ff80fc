// The extension of the solids' motion into the fluid: what it reproduces, and how far gaps close before it
// folds.
#include "fom/mapping/domain_extension.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <limits>

#include "fom/assembly/part_geometry.hpp"
#include "fom/mapping/unfolding.hpp"
#include "geometry/wave_pump/pump.hpp"
#include "rom/base/error.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
using Profile = std::function<Point<2>(const Point<2>&)>;

const ExtensionSettings harmonic{2, 1, 0};

Eigen::VectorXd solid_displacement(const Discretisation<2>& disc, const Profile& profile) {
  Eigen::VectorXd d(disc.solid_unknowns());
  Eigen::Index at = 0;
  for (const auto& space : disc.solid_spaces)
    for (const auto& x : space.nodes) {
      d.segment<2>(at) = profile(x);
      at += 2;
    }
  return d;
}

/// Smallest multiple of the displacement at which an element folds, to 0.5 % of `most`; `most` if none does.
double folding_multiple(Discretisation<2>& disc, const DomainExtension<2>& extension,
                        const Eigen::VectorXd& displacement, double most) {
  const auto whole = extend(extension, displacement);
  constexpr int steps = 200;
  for (int step = 1; step < steps; ++step) {
    disc.map.displacement = whole;
    for (auto& d : disc.map.displacement) d *= most * step / steps;
    const bool folded = smallest_volume_ratio(disc) <= 0;
    disc.map.displacement = whole;
    if (folded) return most * step / steps;
  }
  return most;
}

/// Multiple of an axial displacement at which a vertex of the first solid's skin meets a wall above or below.
double closing_multiple(const Discretisation<2>& disc, const Profile& profile) {
  const auto& background = disc.problem.background;
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& facet : disc.problem.solids[0].mesh.boundary)
    for (const int point : facet.points) {
      const Point<2> x = disc.problem.solids[0].mesh.points[point];
      const double way = profile(x)[1];
      for (const auto& wall : background.boundary) {
        const auto &a = background.points[wall.points[0]], &b = background.points[wall.points[1]];
        if ((a[0] - x[0]) * (b[0] - x[0]) > 0 || a[0] == b[0]) continue;
        const double height = a[1] + (b[1] - a[1]) * (x[0] - a[0]) / (b[0] - a[0]) - x[1];
        if (height * way > 0) smallest = std::min(smallest, height / way);
      }
    }
  return smallest;
}

Discretisation<2> plate_in_channel(Space space) {
  return discretise(channel_with_plate(space), CutOptions{});
}

Discretisation<2> pump(double gap_elements) {
  const auto profile =
      read_pump_profile(std::string(UNDULA_SOURCE_DIR) + "/data/profiles/wave_pump_profile.toml");
  const PumpMeshSizes sizes{gap_elements, 0.08, 0.04, 0.3};
  FsiProblem<2> problem;
  problem.space = Space::axisymmetric;
  problem.fluid = {1.0, 0.035};
  problem.stabilisation = derived_weights(100, 1e-4);
  problem.background = pump_background(profile, sizes);
  using Kind = BoundaryCondition<2>::Kind;
  for (const auto& name : problem.background.boundary_names)
    problem.boundary[name].kind = name == "axis"                              ? Kind::symmetry
                                  : name == inlet_name || name == outlet_name ? Kind::opening
                                                                              : Kind::velocity;
  for (auto mesh : {pump_membrane(profile, sizes), pump_magnet(profile, sizes)}) {
    SolidBody<2> body;
    body.mesh = std::move(mesh);
    body.properties = {1, 1e6, 0.3, 0.0};
    problem.solids.push_back(std::move(body));
  }
  return discretise(std::move(problem), CutOptions{});
}

/// Largest distance between the map of the fluid and the displaced skin, over the skin's quadrature points,
/// and its root mean square. cm.
std::pair<double, double> mismatch(const Discretisation<2>& disc, const Eigen::VectorXd& displacement) {
  double largest = 0, squared = 0, length = 0;
  for (const auto& piece : disc.cut.interface) {
    const auto geometry = part_geometry(disc, piece.part);
    const auto& nodes = disc.solid_spaces[piece.solid].cell_nodes[piece.solid_cell];
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& place = disc.cut.interface_quadrature.points[q];
      const auto shape = quadratic_values<2>(
          barycentric_coordinates(disc.placed_solids[piece.solid], piece.solid_cell, place));
      Point<2> moved = place;
      for (std::size_t k = 0; k < nodes.size(); ++k)
        moved += shape[k] * displacement.segment<2>(disc.solid_unknown(piece.solid, nodes[k], 0) -
                                                    disc.fluid_unknowns());
      const double distance = (geometry.corners * geometry.barycentric(place) - moved).norm();
      largest = std::max(largest, distance);
      squared += disc.cut.interface_quadrature.weights[q] * distance * distance;
      length += disc.cut.interface_quadrature.weights[q];
    }
  }
  return {largest, std::sqrt(squared / length)};
}

TEST(DomainExtension, VanishesOnTheBoundaryAndSlidesAlongTheAxis) {
  auto disc = plate_in_channel(Space::axisymmetric);
  const auto extension = prepare_extension(disc);
  const auto displacement =
      solid_displacement(disc, [](const Point<2>& x) { return Point<2>(0.01 * x[0], 0.1 + 0.05 * x[0]); });
  const auto field = extend(extension, displacement);
  double on_axis = 0;
  for (std::size_t node = 0; node < field.size(); ++node) {
    const auto& x = disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]];
    if (x[0] == 0) {
      EXPECT_EQ(field[node][0], 0.0);
    }
    if (x[1] == 0 || x[1] == Sizes::height || x[0] == Sizes::radius) {
      EXPECT_EQ(field[node].norm(), 0.0);
    }
    if (x[0] == 0) on_axis = std::max(on_axis, field[node][1]);
  }
  EXPECT_GT(on_axis, 0.01);
  // Linear in the displacement.
  const auto twice = extend(extension, Eigen::VectorXd(2 * displacement));
  for (std::size_t node = 0; node < field.size(); ++node)
    EXPECT_LT((twice[node] - 2 * field[node]).norm(), 1e-13);
}

TEST(DomainExtension, FoldsOnlyWhenAGapCloses) {
  auto disc = plate_in_channel(Space::plane);
  const auto extension = prepare_extension(disc), plain = prepare_extension(disc, harmonic);
  for (const double direction : {1.0, -1.0}) {
    const Profile profile = [&](const Point<2>&) { return Point<2>(0.0, direction); };
    const auto displacement = solid_displacement(disc, profile);
    const double closed = closing_multiple(disc, profile);
    const double folds_plain = folding_multiple(disc, plain, displacement, closed) / closed;
    const double folds = folding_multiple(disc, extension, displacement, closed) / closed;
    const auto [largest, mean] = mismatch(disc, displacement);
    std::printf(
        "plate %+.0f: gap %.4f cm; folds at %.3f of it, harmonic reach %.3f; off the skin by at most %.4f, "
        "rms "
        "%.4f of the displacement\n",
        direction, closed, folds, folds_plain, largest, mean);
    EXPECT_GT(folds, 0.9);
    EXPECT_LT(folds_plain, 0.8);
    EXPECT_LT(mean, 0.03);
  }
}

/// The pump's membrane bent at its tip, and carried as a whole with its holder.
TEST(DomainExtension, FoldsOnlyWhenAGapClosesInThePump) {
  for (const double elements : {3.0, 5.0, 12.0}) {
    auto disc = pump(elements);
    const auto start = std::chrono::steady_clock::now();
    const auto extension = prepare_extension(disc);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto plain = prepare_extension(disc, harmonic);
    std::printf("pump, %.0f elements per gap, %zu fluid nodes: prepared in %.2f s\n", elements,
                disc.fluid_nodes.dof_point.size(), seconds);
    double tip = std::numeric_limits<double>::infinity(), rim = 0;
    for (const auto& x : disc.problem.solids[0].mesh.points) {
      tip = std::min(tip, x[0]);
      rim = std::max(rim, x[0]);
    }
    for (const bool bends : {true, false})
      for (const double direction : {1.0, -1.0}) {
        const Profile profile = [&](const Point<2>& x) {
          const double part = bends ? std::max(0.0, (rim - x[0]) / (rim - tip)) : 1.0;
          return Point<2>(0.0, direction * part * part);
        };
        const auto displacement = solid_displacement(disc, profile);
        const double closed = closing_multiple(disc, profile);
        const double folds_plain = folding_multiple(disc, plain, displacement, closed) / closed;
        const double folds = folding_multiple(disc, extension, displacement, closed) / closed;
        const auto [largest, mean] = mismatch(disc, displacement);
        std::printf(
            "  %s %+.0f: gap %.4f cm; folds at %.3f of it, harmonic reach %.3f; off the skin by at most "
            "%.4f, "
            "rms %.4f of the displacement\n",
            bends ? "bent   " : "carried", direction, closed, folds, folds_plain, largest, mean);
        EXPECT_GT(folds, bends ? 0.93 : 0.98);
        if (!bends) {
          EXPECT_GT(folds, 1.1 * folds_plain);
        }
        EXPECT_LT(mean, 0.02);
      }
  }
}

/// A flag that stands in the left wall of a channel, n elements across it, rolled up evenly: turned by 0.6 at
/// its tip, which rises by half of the gap. The fluid turns along; what is left of the volume of the smallest
/// element.
double volume_left_at_a_turning_tip(int n, double smoothing) {
  FsiProblem<2> problem;
  problem.fluid = {1, 1};
  problem.stabilisation = derived_weights(1, 1);
  const double h = 0.2 / n;
  problem.background =
      tensor_mesh(spaced(0, 4.8, static_cast<int>(4.8 / h)), spaced(0, 4.1, static_cast<int>(4.1 / h)),
                  {"wall", "wall", "wall", "wall"});
  problem.boundary["wall"].kind = BoundaryCondition<2>::Kind::velocity;
  SolidBody<2> flag;
  flag.mesh = box({-0.35, 1.95}, {3.5, 2.15}, 77, 4);
  flag.properties = {1, 1e6, 0.3, 0.0};
  problem.solids.push_back(std::move(flag));
  auto disc = discretise(std::move(problem), CutOptions{});
  ExtensionSettings settings;
  settings.smoothing = smoothing;
  const double curvature = 0.6 / 3.5;
  disc.map.displacement =
      extend(prepare_extension(disc, settings), solid_displacement(disc, [&](const Point<2>& x) {
               const double turn = curvature * std::max(x[0], 0.0), off = x[1] - 2.05;
               const double along = x[0] > 0 ? std::sin(turn) / curvature : x[0];
               const Point<2> moved(along - off * std::sin(turn),
                                    2.05 + (1 - std::cos(turn)) / curvature + off * std::cos(turn));
               return Point<2>(moved - x);
             }));
  const auto smallest = smallest_volume(disc);
  std::printf("turning tip, %d elements across, smoothed over %.0f thicknesses: J %.3f at (%.2f, %.2f)\n", n,
              smoothing, smallest.ratio, smallest.place[0], smallest.place[1]);
  return smallest.ratio;
}

TEST(DomainExtension, TurnsTheFluidWithATip) {
  EXPECT_GT(volume_left_at_a_turning_tip(6, ExtensionSettings{}.smoothing), 0.2);
  // An elastic medium alone has a corner's singularity.
  EXPECT_LT(volume_left_at_a_turning_tip(6, 0), 0.0);
}

using Map = std::vector<Point<2>>;

/// A plate that closes `part` of its gap, by a harmonic reach, which folds at 0.72.
Map folding_target(const Discretisation<2>& disc, const DomainExtension<2>& plain, double part) {
  const Profile profile = [](const Point<2>&) { return Point<2>(0.0, 1.0); };
  return extend(plain,
                Eigen::VectorXd(part * closing_multiple(disc, profile) * solid_displacement(disc, profile)));
}

TEST(Unfolding, OpensWhatAMapFolds) {
  auto disc = plate_in_channel(Space::plane);
  const auto plain = prepare_extension(disc, harmonic);
  const auto unfolding = prepare_unfolding(disc);
  const Profile profile = [](const Point<2>&) { return Point<2>(0.0, 1.0); };
  const double closed = closing_multiple(disc, profile);
  Map last(disc.fluid_nodes.dof_point.size(), Point<2>::Zero());
  for (const double part : {0.3, 0.6, 0.8, 0.9, 0.95}) {
    const Map target = folding_target(disc, plain, part);
    const auto starts = [&] { return std::vector{in_a_row<2>(last)}; };
    const auto map = unfold<2>(unfolding, target, starts);
    disc.map.displacement = target;
    const double before = smallest_volume_ratio(disc);
    disc.map.displacement = map.displacement;
    const double after = smallest_volume_ratio(disc);
    const Eigen::VectorXd moved = part * closed * solid_displacement(disc, profile);
    const double mean = mismatch(disc, moved).second;
    disc.map.displacement = target;
    const double of_target = mismatch(disc, moved).second;
    disc.map = {};
    std::printf(
        "%.2f of the gap: J %.4f, corrected %.4f in %d iterations; off the skin by %.4f of the way, target "
        "%.4f\n",
        part, before, after, map.iterations, mean / (part * closed), of_target / (part * closed));
    EXPECT_EQ(map.iterations == 0, before >= unfolding.settings.threshold);
    EXPECT_EQ(before<0, part> 0.75);
    EXPECT_GT(after, 0.15 * (1 - part)); // an even share of what is left would be 1 - part
    EXPECT_NEAR(after, map.smallest_ratio, 1e-12);
    EXPECT_LT(mean, 1.02 * of_target);
    for (std::size_t node = 0; node < map.displacement.size(); ++node) {
      const auto& x = disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]];
      if (x[1] == 0 || x[1] == Sizes::height) {
        EXPECT_EQ(map.displacement[node].norm(), 0.0);
      }
    }
    last = map.displacement;
  }
}

// The correction grows from nothing: the map has no jump in time where it begins.
TEST(Unfolding, BeginsWithoutAJump) {
  const auto disc = plate_in_channel(Space::plane);
  const auto plain = prepare_extension(disc, harmonic);
  const auto unfolding = prepare_unfolding(disc);
  Map last(disc.fluid_nodes.dof_point.size(), Point<2>::Zero());
  double correction_before = 0, greatest_jump = 0;
  int corrected = 0;
  constexpr double step = 0.005;
  for (double part = 0.3; part < 0.8; part += step) {
    const Map target = folding_target(disc, plain, part);
    const auto starts = [&] { return std::vector{in_a_row<2>(last)}; };
    const auto map = unfold<2>(unfolding, target, starts);
    double correction = 0, way = 0;
    for (std::size_t node = 0; node < target.size(); ++node) {
      correction = std::max(correction, (map.displacement[node] - target[node]).norm());
      way = std::max(way, (target[node]).norm() * step / part);
    }
    corrected += map.iterations > 0;
    greatest_jump = std::max(greatest_jump, std::abs(correction - correction_before) / way);
    correction_before = correction;
    last = map.displacement;
  }
  std::printf("corrected in %d steps, the correction changes by at most %.2f of the way of the plate\n",
              corrected, greatest_jump);
  EXPECT_GT(corrected, 20);
  EXPECT_LT(greatest_jump, 0.3);
}

TEST(Unfolding, RefusesAStartThatIsFolded) {
  const auto disc = plate_in_channel(Space::plane);
  const auto plain = prepare_extension(disc, harmonic);
  const Map target = folding_target(disc, plain, 0.9);
  const auto starts = [&] { return std::vector{in_a_row<2>(target)}; };
  EXPECT_THROW(unfold<2>(prepare_unfolding(disc), target, starts), NumericsError);
}

} // namespace
} // namespace undula::fom
