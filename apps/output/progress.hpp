// Progress with an estimate of the time left, on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace undula::apps {

/// One line on stderr that is overwritten at most five times a second; silent where stderr is not a terminal.
class Progress {
public:
  Progress(std::string label, long total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress(); ///< ends the line

  /// `done` of `total` are finished.
  void update(long done);

private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  long total_ = 0;
  bool on_terminal_ = false;
  bool drawn_ = false;
  Clock::time_point begin_;
  Clock::time_point last_;
};

/// The line without carriage return: "label  37 %  12/32  1:05 left". `elapsed_s` is the time since the
/// start.
std::string progress_line(const std::string& label, long done, long total, double elapsed_s);

} // namespace undula::apps
