#include "fom/levels/period_check.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "fom/levels/extrapolation.hpp"

namespace undula::fom {
namespace {

/// Compares whole states in the metric of the level, and extrapolates them.
class WholeStates final : public PeriodCheck {
public:
  WholeStates(std::unique_ptr<StateMetric> metric, const Scene& scene)
      : metric_(std::move(metric)),
        tolerance_(scene.training.periodic_tolerance),
        sampled_periods_(scene.training.sampled_periods),
        periods_(scene.time.periods) {}

  void begin(const State& state) override {
    start_x_ = state.x[0];
    start_d_ = state.d[0];
  }

  void step(const State&, const Observation&) override {}

  bool end(int period, bool ramped, State& state) override {
    ++plain_periods_;
    replaced_ = false;
    // Velocity and displacement are each measured in the mass: a membrane that creeps by a little every
    // period has a small velocity all along, and only its displacement tells.
    change_ = std::max(relative_change(state.x[0], start_x_), relative_change(state.d[0], start_d_));
    if (ramped) return false;
    // The sampled periods must follow one another without a jump.
    if (change_ < tolerance_ && plain_periods_ >= sampled_periods_) return true;
    if (just_extrapolated_) {
      just_extrapolated_ = false;
      if (change_ > accepted_growth * change_before_) {
        replace(state, before_extrapolation_);
        may_extrapolate_ = false;
        ends_.clear();
        return false;
      }
    }
    ends_.push_back(state);
    if (ends_.size() <= window) return false;
    if (may_extrapolate_ && period + 2 <= periods_)
      extrapolate(state);
    else
      ends_.pop_front();
    return false;
  }

  bool replaced() const override { return replaced_; }

  std::string left() const override { return "the state still changes by " + std::to_string(change_); }

private:
  // Extrapolation looks back over so many periods. More bring in the noise of fast modes.
  static constexpr std::size_t window = 4;
  // An extrapolated state is kept if the next period changes less than this factor times the change before.
  static constexpr double accepted_growth = 2.0;

  double relative_change(const Eigen::VectorXd& now, const Eigen::VectorXd& before) const {
    return metric_->norm(now - before) / std::max(metric_->norm(now), 1e-300);
  }

  /// Time goes on, the state is another.
  void replace(State& state, const State& other) {
    const int step = state.step;
    const double time = state.time;
    state = other;
    state.step = step;
    state.time = time;
    plain_periods_ = 0;
    replaced_ = true;
  }

  void extrapolate(State& state) {
    // Coordinates in which velocity and displacement weigh the same.
    const double balance = metric_->norm(state.x[0]) / std::max(metric_->norm(state.d[0]), 1e-300);
    const auto& root = metric_->root_weights;
    const Eigen::Index size = root.size();
    Eigen::MatrixXd differences(2 * size, static_cast<Eigen::Index>(window));
    for (std::size_t i = 0; i < window; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      differences.col(column).head(size) = root.cwiseProduct(ends_[i + 1].x[0] - ends_[i].x[0]);
      differences.col(column).tail(size) = balance * root.cwiseProduct(ends_[i + 1].d[0] - ends_[i].d[0]);
    }
    before_extrapolation_ = state;
    change_before_ = change_;
    replace(state, combine(extrapolation_weights(differences)));
    just_extrapolated_ = true;
    ends_.clear();
    ends_.push_back(state);
  }

  State combine(const Eigen::VectorXd& weights) const {
    State sum = ends_.back();
    for (std::size_t level = 0; level < 2; ++level) {
      sum.x[level].setZero();
      sum.d[level].setZero();
      for (Eigen::Index i = 0; i < weights.size(); ++i) {
        const auto& end = ends_[static_cast<std::size_t>(i) + 1];
        sum.x[level] += weights[i] * end.x[level];
        sum.d[level] += weights[i] * end.d[level];
      }
    }
    return sum;
  }

  std::unique_ptr<StateMetric> metric_;
  double tolerance_ = 0;
  int sampled_periods_ = 0, periods_ = 0;
  Eigen::VectorXd start_x_, start_d_;
  std::deque<State> ends_; ///< of the last periods, plainly marched one after the other
  State before_extrapolation_;
  double change_ = 1, change_before_ = 1;
  bool just_extrapolated_ = false, may_extrapolate_ = true, replaced_ = false;
  int plain_periods_ = 0;
};

/// Compares the mean flow and the displacements at the end of two periods.
class FlowAndDisplacement final : public PeriodCheck {
public:
  FlowAndDisplacement(const MarchingLevel& level, const Scene& scene)
      : level_(level),
        tolerance_(scene.training.periodic_tolerance),
        steps_per_period_(scene.time.steps_per_period) {}

  void begin(const State&) override { now_ = {}; }

  void step(const State& state, const Observation& seen) override {
    now_.mean_outflow += seen.outflow / steps_per_period_;
    now_.rms_outflow += seen.outflow * seen.outflow / steps_per_period_;
    now_.largest_displacement =
        std::max(now_.largest_displacement, level_.displacements(state).lpNorm<Eigen::Infinity>());
  }

  bool end(int, bool ramped, State& state) override {
    now_.rms_outflow = std::sqrt(now_.rms_outflow);
    now_.displacement = level_.displacements(state);
    if (before_) change_ = relative_change(now_, *before_);
    if (change_ < tolerance_) return true;
    // A period within the smooth start is no measure of the next one.
    before_.reset();
    if (!ramped) before_ = now_;
    return false;
  }

  std::string left() const override {
    return "flow or displacement still change by " + std::to_string(change_);
  }

private:
  struct Period {
    double mean_outflow = 0, rms_outflow = 0; ///< cm^3/s
    double largest_displacement = 0;          ///< cm, over the period
    Eigen::VectorXd displacement;             ///< cm, at its end
  };

  /// Change from one period to the next, as a part of what it is measured by; 0 for two periods of rest.
  static double relative_change(const Period& now, const Period& before) {
    const auto part = [](double change, double scale) { return change == 0 ? 0 : change / scale; };
    return std::max(
        part(std::abs(now.mean_outflow - before.mean_outflow), now.rms_outflow),
        part((now.displacement - before.displacement).lpNorm<Eigen::Infinity>(), now.largest_displacement));
  }

  const MarchingLevel& level_;
  double tolerance_ = 0;
  int steps_per_period_ = 0;
  Period now_;
  std::optional<Period> before_;
  double change_ = std::numeric_limits<double>::infinity();
};

} // namespace

std::unique_ptr<PeriodCheck> period_check(const MarchingLevel& level, const Scene& scene) {
  if (auto metric = level.metric()) return std::make_unique<WholeStates>(std::move(metric), scene);
  return std::make_unique<FlowAndDisplacement>(level, scene);
}

} // namespace undula::fom
