#include "apps/output/progress.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace undula::apps {

Progress::Progress(std::string label, long total, long log_every)
    : label_(std::move(label)),
      total_(total),
      log_every_(log_every),
      on_terminal_(isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      last_(begin_) {}

Progress::~Progress() {
  if (drawn_) {
    std::fputc('\n', stderr);
  }
}

void Progress::update(long done) {
  const auto now = Clock::now();
  if (!on_terminal_) {
    if (log_every_ > 0 && done > 0 && done % log_every_ == 0) {
      spdlog::info("{}",
                   progress_line(label_, done, total_, std::chrono::duration<double>(now - begin_).count()));
    }
    return;
  }
  if (done < total_ && now - last_ < std::chrono::milliseconds(200)) {
    return;
  }
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  // ESC [K clears what a longer line left behind.
  std::fprintf(stderr, "\r%s\033[K", progress_line(label_, done, total_, elapsed).c_str());
  std::fflush(stderr);
}

std::string progress_line(const std::string& label, long done, long total, double elapsed_s) {
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1;
  std::string line = label + "  " + std::to_string(static_cast<int>(std::floor(100 * part))) + " %  " +
                     std::to_string(done) + "/" + std::to_string(total);
  if (done > 0 && done < total) {
    const long left = std::lround(std::ceil(elapsed_s * (1 / part - 1)));
    char time[32];
    if (left < 3600) {
      std::snprintf(time, sizeof time, "  %ld:%02ld left", left / 60, left % 60);
    } else {
      std::snprintf(time, sizeof time, "  %ld:%02ld:%02ld left", left / 3600, left / 60 % 60, left % 60);
    }
    line += time;
  }
  return line;
}

} // namespace undula::apps
