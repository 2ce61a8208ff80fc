// A march of a stepper that sees for itself what there is to see.
#pragma once

#include "fom/levels/level.hpp"

namespace undula::fom {

template <class Stepper>
class SteppedMarcher final : public Marcher {
public:
  template <class Model>
  SteppedMarcher(const Model& model, const Scene& scene, PhaseTimer& timer) : stepper_(model, scene, timer) {}
  Observation advance(State& state) override { return stepper_.advance(state); }

private:
  Stepper stepper_;
};

} // namespace undula::fom
