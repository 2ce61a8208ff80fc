// Wall-clock time per named phase (mesh, cut, assemble, factor, solve, output), accumulated over a run.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace undula {

/// Seconds and call counts per phase.
class PhaseTimer {
public:
  struct Record {
    double seconds = 0;
    long calls = 0;
  };

  /// Adds the lifetime of the returned object to `phase`.
  class Scope {
  public:
    Scope(PhaseTimer& timer, std::string phase)
        : timer_(timer), phase_(std::move(phase)), begin_(std::chrono::steady_clock::now()) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
      auto& record = timer_.records_[phase_];
      record.seconds += elapsed.count();
      ++record.calls;
    }

  private:
    PhaseTimer& timer_;
    std::string phase_;
    std::chrono::steady_clock::time_point begin_;
  };

  [[nodiscard]] Scope measure(std::string phase) { return Scope(*this, std::move(phase)); }
  const std::map<std::string, Record>& records() const { return records_; }

private:
  std::map<std::string, Record> records_;
};

} // namespace undula
