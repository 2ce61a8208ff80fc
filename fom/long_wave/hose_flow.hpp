// The flow along a squeezed hose: its equation, and a step of it.
//
// With u = Q / A the mean velocity, the momentum of the fluid integrated from inlet to outlet reads
//   d/dt int rho u ds = p(0) - p(L) - rho/2 (u(L)^2 - u(0)^2) - friction - losses behind the rollers.
// Losses are those of the flow relative to a roller, w = u - its speed: behind the throat the kinetic
// pressure rho/2 (w_throat^2 - w_open^2) is lost but for hose.throat_recovery. At the ends a reservoir's
// pressure is the total one of what enters (less hose.entry_loss) and the static one of what leaves.
#pragma once

#include <vector>

#include "fom/long_wave/squeezed_place.hpp"
#include "fom/output/observables.hpp"
#include "fom/time/state.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// The hose at a time.
struct HoseInstant {
  double time = 0;                   ///< s
  std::vector<SqueezedPlace> places; ///< from the inlet to the outlet
};

/// What an outflow (cm^3/s) means for the hose, cgs.
struct HoseFlow {
  double outflow = 0, inflow = 0;       ///< cm^3/s
  double momentum = 0;                  ///< int rho u ds, g/(cm s)
  double drive = 0;                     ///< right hand side of the equation above, dyn/cm^2
  double kinetic = 0;                   ///< energy, erg
  double opening = 0;                   ///< power of the pressures at the ends, erg/s
  double dissipation = 0;               ///< by friction, behind rollers and at the entry, erg/s
  double carried = 0;                   ///< kinetic energy carried out of the ends, erg/s
  double leak = 0;                      ///< backwards through the narrowest place, cm^3/s; 0 without one
  double speed_max = 0;                 ///< cm/s
  double shear_max = 0, shear_mean = 0; ///< of the wall, dyn/cm^2; mean over the length
};

/// Pressure gradient of the wall's friction, dyn/cm^3, against a flow through a bore.
double friction_gradient(const FluidProperties& fluid, double flow, double area, double conductance,
                         double diameter);

/// The same in the open bore.
double open_friction_gradient(const HoseModel& model, double flow);

/// Static pressure just inside the outlet at a head.
double outlet_static_pressure(const HoseModel& model, double head, double outflow);

HoseInstant hose_at(const HoseModel& model, double frequency, double time);
HoseFlow hose_flow(const HoseModel& model, const HoseInstant& instant, double head, double outflow);

/// Elastic energy of the hose, erg; 0 where its modulus is not stated.
double elastic_energy(const HoseModel& model, const HoseInstant& instant);

/// x: the outflow, at the current step and the one before; d: how far each roller presses the bore, cm.
State hose_state_at_rest(const HoseModel& model);

/// One march. Steps by a diagonally implicit Runge-Kutta scheme of order 2 that damps stiff parts out
/// (Alexander 1977, SIAM J. Numer. Anal. 14, 1006; gamma = 1 - 1/sqrt(2)).
class HoseStepper {
public:
  /// The operating point of `scene`. `model` and `timer` have to outlive it.
  HoseStepper(const HoseModel& model, const Scene& scene, PhaseTimer& timer);

  /// One step. Throws NumericsError, leaving `state` as it is, where no outflow solves the equation.
  Observation advance(State& state) const;

private:
  double solve_stage(const HoseInstant& instant, double weight, double right_side, double guess) const;
  Observation observe(const State& before, const State& after, const HoseInstant& instant) const;

  const HoseModel& model_;
  PhaseTimer& timer_;
  double frequency_ = 0, head_ = 0, step_ = 0;
};

} // namespace undula::fom
