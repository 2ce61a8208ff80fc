// Closures of the thin-gap level: contact, heights, friction, Bernoulli with losses, energy of the plate.
#include <gtest/gtest.h>

#include <random>

#include "fom/thin_gap/contact_law.hpp"
#include "fom/thin_gap/gap_flow.hpp"
#include "fom/thin_gap/plate.hpp"
#include "fom/thin_gap/step_energy.hpp"

namespace undula::fom {
namespace {

ThinGapSettings contact_settings() {
  ThinGapSettings settings;
  settings.film_thickness = 0.005;
  settings.contact_stiffness = 1e8;
  return settings;
}

GapFlowLaw law_with(double throat, double exit, double entry) {
  GapFlowLaw law;
  law.density = 1;
  law.viscosity = 0.035;
  law.momentum_factor = 1.2;
  law.throat_recovery = throat;
  law.exit_recovery = exit;
  law.entry_loss = entry;
  law.turning_velocity = 0.1;
  law.least_height = 0.0025;
  return law;
}

TEST(ContactPressure, SetsInSmoothlyAndGrowsLinearly) {
  const auto settings = contact_settings();
  const double film = settings.film_thickness, onset = film / 5;
  EXPECT_EQ(contact_pressure(settings, film), 0);
  EXPECT_EQ(contact_pressure(settings, 2 * film), 0);
  for (const double corner : {film, film - onset}) { // value and slope are continuous
    const double e = 1e-9;
    const double below = contact_pressure(settings, corner - e), at = contact_pressure(settings, corner),
                 above = contact_pressure(settings, corner + e);
    EXPECT_NEAR(below, above, 2.1 * e * settings.contact_stiffness);
    EXPECT_NEAR((below - at) / e, (at - above) / e, 1e-4 * settings.contact_stiffness);
  }
  // Linear beyond the onset, and through the wall.
  EXPECT_NEAR(contact_pressure(settings, -0.001) - contact_pressure(settings, 0.0), 1e5, 1e-6);
  EXPECT_NEAR(contact_pressure(settings, 0.0), 1e8 * (film - onset / 2), 1e-6);
}

/// A plate at rest that does nothing but touch: its elastic energy is the integral of the contact pressure.
TEST(ContactPressure, HasItsEnergyAsAntiderivative) {
  ThinGapLayout layout;
  for (int i = 0; i <= 4; ++i) {
    layout.radius.push_back(0.5 + 0.1 * i);
    layout.thickness.push_back(0.1);
    layout.lower_height.push_back(0.1);
    if (i <= 3) layout.upper_height.push_back(0.02);
  }
  layout.clamp = 0;
  layout.channel = 3;
  layout.inlet = layout.rim = layout.outlet = {1, 1, 1};
  Scene scene;
  scene.thin_gap = contact_settings();
  scene.fluid = {1, 0.035};
  scene.membrane = {1.125, 1e7, 0.49, 0};
  scene.operating_point = {100, 0.03, 0, 1};
  scene.time.steps_per_period = 100;
  const ThinGapUnknowns at{5};
  State state;
  for (auto& x : state.x) x.setZero(at.size());
  for (auto& d : state.d) d.setZero(at.displacements());
  const auto energy = [&](double lift) {
    for (auto& d : state.d)
      for (int node = 0; node < at.nodes; ++node) d[at.deflection(node)] = lift;
    return thin_gap_energy(next_step(layout, scene, state), state.x[0], 0).elastic;
  };
  double area = 0;
  for (int node = 0; node < layout.channel; ++node) area += node_area(layout, node);
  EXPECT_EQ(energy(0.0149), 0);
  for (const double lift : {0.0153, 0.01599, 0.01601, 0.018, 0.021}) {
    const double e = 1e-6;
    const double slope = (energy(lift + e) - energy(lift - e)) / (2 * e);
    const double expected = area * contact_pressure(scene.thin_gap, 0.02 - lift);
    EXPECT_NEAR(slope, expected, 1e-3 * expected) << lift;
    EXPECT_GT(expected, 0);
  }
}

TEST(OpenHeight, IsTheHeightWhereOpenAndPositiveWhereSolidsOverlap) {
  const auto law = law_with(0, 0, 0.5);
  EXPECT_NEAR(open_height(law, 0.1), 0.1, 0.001 * 0.1);
  EXPECT_NEAR(open_height(law, 0.0), law.least_height, 1e-15);
  double before = 0;
  for (double h = -0.05; h < 0.05; h += 0.001) {
    EXPECT_GT(open_height(law, h), before); // rises, and stays positive
    before = open_height(law, h);
  }
}

TEST(GapFriction, IsThatOfAParabolaAndOfStokesLayers) {
  auto law = law_with(0, 0, 0.5);
  EXPECT_NEAR(gap_friction(law, 0.1), 12 * 0.035 / 0.01, 1e-12);
  law.stokes_layer = 0.01;
  EXPECT_NEAR(gap_friction(law, 0.059), 12 * 0.035 / (0.059 * 0.059), 1e-9); // narrow: developed
  EXPECT_NEAR(gap_friction(law, 0.1), 2 * 0.035 / (0.1 * 0.01), 1e-12);
  EXPECT_NEAR(gap_friction(law, 0.06 * (1 - 1e-9)), gap_friction(law, 0.06 * (1 + 1e-9)), 1e-6);
}

TEST(ConvectiveDrop, IsBernoulliWhereTheFlowSpeedsUp) {
  const auto law = law_with(0.25, 0, 0.5);
  // Outwards from 20 to 50 cm/s, and the same inwards: the faster place has the lower pressure.
  const double slow = kinetic_pressure(law, 20.0), fast = kinetic_pressure(law, 50.0);
  EXPECT_NEAR(convective_drop(law, 35.0, slow, fast), fast - slow, 0.01);
  EXPECT_NEAR(convective_drop(law, -35.0, fast, slow), slow - fast, 0.01);
  // Slowing down returns a quarter.
  EXPECT_NEAR(convective_drop(law, 35.0, fast, slow), 0.25 * (slow - fast), 0.01);
  EXPECT_NEAR(convective_drop(law, -35.0, slow, fast), 0.25 * (fast - slow), 0.01);
  auto full = law_with(1, 1, 0);
  EXPECT_NEAR(convective_drop(full, 35.0, fast, slow), slow - fast, 0.01);
  full.convective = false;
  EXPECT_EQ(convective_drop(full, 35.0, fast, slow), 0);
  EXPECT_EQ(drop_at_beginning(full, 35.0, fast), 0);
  EXPECT_EQ(drop_at_end(full, 35.0, fast), 0);
}

TEST(Ends, TakeTheEntryLossAndReturnTheExitRecovery) {
  const auto law = law_with(0, 0.3, 0.5);
  const double k = kinetic_pressure(law, 40.0);
  EXPECT_NEAR(drop_at_beginning(law, 40.0, k), 1.5 * k, 1e-9);  // into the gap
  EXPECT_NEAR(drop_at_beginning(law, -40.0, k), 0.3 * k, 1e-9); // out of it: the jet's part returns
  EXPECT_NEAR(drop_at_end(law, 40.0, k), -0.3 * k, 1e-9);
  EXPECT_NEAR(drop_at_end(law, -40.0, k), -1.5 * k, 1e-9);
}

/// Power lost between two places: flow times (drop of static pressure less the gain of kinetic pressure).
TEST(Losses, AreNeverNegative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int sample = 0; sample < 20000; ++sample) {
    const auto law = law_with(unit(random), unit(random), 2 * unit(random));
    const double u = 200 * (unit(random) - 0.5) * std::pow(unit(random), 4);
    const double before = kinetic_pressure(law, 200 * (unit(random) - 0.5)),
                 after = kinetic_pressure(law, 200 * (unit(random) - 0.5)), k = kinetic_pressure(law, u);
    // The smoothing of the direction below the turning velocity may give back no more than that velocity
    // holds.
    const double little =
        0.5 * law.density * law.turning_velocity * law.turning_velocity * law.turning_velocity;
    // Well above the turning velocity its tanh is one but for 7e-4.
    if (std::abs(u) > 4 * law.turning_velocity) {
      const double lost = convective_drop(law, u, before, after) - (after - before);
      EXPECT_GE(u * lost, -std::abs(u) * (2e-3 * (before + after) + 0.01));
    }
    EXPECT_GE(u * (drop_at_beginning(law, u, k) - k), -little);
    EXPECT_GE(u * (drop_at_end(law, u, k) + k), -little);
    EXPECT_GT(gap_friction(law, open_height(law, 0.1 * (unit(random) - 0.5))), 0);
  }
}

/// Forces are the gradient of the elastic energy, and the viscous part dissipates.
TEST(PlateForces, DeriveFromTheirEnergy) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const PlateElement element{1.2, 0.05, 0.1};
  const SolidProperties material{1.125, 1.686e7, 0.49, 1e-4};
  for (const auto model : {SolidModel::linear, SolidModel::von_karman}) {
    std::array<double, 6> d{}, v{};
    for (int k = 0; k < 6; ++k) {
      d[k] = 0.02 * unit(random);
      v[k] = unit(random);
    }
    const auto forces = [&](const std::array<double, 6>& at, const std::array<double, 6>& rate) {
      return plate_forces<double>(element, material, model, {{{at[0], at[1], at[2]}, {at[3], at[4], at[5]}}},
                                  {{{rate[0], rate[1], rate[2]}, {rate[3], rate[4], rate[5]}}});
    };
    const auto list = [](const PlateForces<double>& f) {
      return std::array<double, 6>{f.inner.w, f.inner.theta, f.inner.u, f.outer.w, f.outer.theta, f.outer.u};
    };
    const auto still = list(forces(d, {}));
    double largest = 0;
    for (const double f : still) largest = std::max(largest, std::abs(f));
    for (int k = 0; k < 6; ++k) {
      const double h = 1e-6;
      auto more = d, less = d;
      more[k] += h;
      less[k] -= h;
      EXPECT_NEAR((forces(more, {}).elastic - forces(less, {}).elastic) / (2 * h), still[k], 1e-6 * largest);
    }
    const auto moving = forces(d, v);
    double power = 0;
    for (int k = 0; k < 6; ++k) power += (list(moving)[k] - still[k]) * v[k];
    EXPECT_NEAR(power, moving.damping, 1e-9 * moving.damping);
    EXPECT_GT(moving.damping, 0);
  }
}

} // namespace
} // namespace undula::fom
