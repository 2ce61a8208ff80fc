// Progress with an estimate of the time left: one line on a terminal, lines of the log elsewhere, lines of
// JSON for programs that ask for them.
#pragma once

#include <chrono>
#include <string>

namespace undula::apps {

/// On a terminal one line on stderr that is overwritten at most five times a second. Elsewhere one line of
/// the log whenever another `log_every` are finished; none for 0. Where the environment says
/// UNDULA_PROGRESS=json, lines of JSON on stderr instead (progress_json), at most five a second and the last.
class Progress {
public:
  Progress(std::string label, long total, long log_every = 0);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress(); ///< ends the line

  /// `done` of `total` are finished.
  void update(long done);

private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  long total_ = 0, log_every_ = 0;
  bool for_programs_ = false;
  bool on_terminal_ = false;
  bool drawn_ = false;
  Clock::time_point begin_;
  Clock::time_point last_;
};

/// The line without carriage return: "label  37 %  12/32  1:05 left". `elapsed_s` is the time since the
/// start.
std::string progress_line(const std::string& label, long done, long total, double elapsed_s);

/// The same for programs: {"progress": label, "done": done, "total": total, "seconds_left": number or null}.
std::string progress_json(const std::string& label, long done, long total, double elapsed_s);

} // namespace undula::apps
