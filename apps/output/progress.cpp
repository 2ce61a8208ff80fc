#include "apps/output/progress.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace undula::apps {
namespace {

/// Seconds until the end, at the pace so far; nothing before the first and after the last.
std::optional<long> seconds_left(long done, long total, double elapsed_s) {
  if (done <= 0 || done >= total) {
    return {};
  }
  const double part = static_cast<double>(done) / static_cast<double>(total);
  return std::lround(std::ceil(elapsed_s * (1 / part - 1)));
}

bool asked_for_json() {
  const char* wanted = std::getenv("UNDULA_PROGRESS");
  return wanted != nullptr && std::string_view(wanted) == "json";
}

} // namespace

Progress::Progress(std::string label, long total, long log_every)
    : label_(std::move(label)),
      total_(total),
      log_every_(log_every),
      for_programs_(asked_for_json()),
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
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  if (!for_programs_ && !on_terminal_) {
    if (log_every_ > 0 && done > 0 && done % log_every_ == 0) {
      spdlog::info("{}", progress_line(label_, done, total_, elapsed));
    }
    return;
  }
  if (done < total_ && now - last_ < std::chrono::milliseconds(200)) {
    return;
  }
  last_ = now;
  if (for_programs_) {
    std::fprintf(stderr, "%s\n", progress_json(label_, done, total_, elapsed).c_str());
    return;
  }
  drawn_ = true;
  // ESC [K clears what a longer line left behind.
  std::fprintf(stderr, "\r%s\033[K", progress_line(label_, done, total_, elapsed).c_str());
  std::fflush(stderr);
}

std::string progress_line(const std::string& label, long done, long total, double elapsed_s) {
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1;
  std::string line = label + "  " + std::to_string(static_cast<int>(std::floor(100 * part))) + " %  " +
                     std::to_string(done) + "/" + std::to_string(total);
  if (const auto left = seconds_left(done, total, elapsed_s)) {
    char time[32];
    if (*left < 3600) {
      std::snprintf(time, sizeof time, "  %ld:%02ld left", *left / 60, *left % 60);
    } else {
      std::snprintf(time, sizeof time, "  %ld:%02ld:%02ld left", *left / 3600, *left / 60 % 60, *left % 60);
    }
    line += time;
  }
  return line;
}

std::string progress_json(const std::string& label, long done, long total, double elapsed_s) {
  const auto left = seconds_left(done, total, elapsed_s);
  const auto left_json = left ? nlohmann::ordered_json(*left) : nlohmann::ordered_json();
  return nlohmann::ordered_json(
             {{"progress", label}, {"done", done}, {"total", total}, {"seconds_left", left_json}})
      .dump();
}

} // namespace undula::apps
