// When a march counts as periodic, and how it gets there sooner: the strategies of march_until_periodic.
#pragma once

#include <memory>
#include <string>

#include "fom/levels/level.hpp"

namespace undula::fom {

class PeriodCheck {
public:
  virtual ~PeriodCheck() = default;

  /// Before the first step of a period.
  virtual void begin(const State& state) = 0;

  /// After every step.
  virtual void step(const State& state, const Observation& seen) = 0;

  /// After the last step of period `period` (from 1) of this march; `ramped`: it began within the smooth
  /// start. Whether the march is periodic now; if not, `state` may be replaced by a better start of the next
  /// period. Collective.
  virtual bool end(int period, bool ramped, State& state) = 0;

  /// Whether the last `end` replaced the state: the flows before belong to another march.
  virtual bool replaced() const { return false; }

  /// What is left of the change from period to period, for a message.
  virtual std::string left() const = 0;
};

/// The strategy for a level. Both have to outlive it.
std::unique_ptr<PeriodCheck> period_check(const MarchingLevel& level, const Scene& scene);

} // namespace undula::fom
