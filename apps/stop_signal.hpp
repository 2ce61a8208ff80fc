// Signals that ask a long computation to stop: it ends its step, keeps its state and says so.
#pragma once

#include <mpi.h>

#include <array>
#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>

namespace undula::apps {

/// Thrown where a computation was stopped on request. Exit code 1.
class Stopped : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// While it lives, SIGTERM, SIGINT, SIGHUP and SIGXCPU only leave a note; the second signal of a kind ends
/// the process as it would have without. Signals that the caller ignores (nohup) stay ignored. One at a time.
class StopSignal {
public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal(); ///< as before

  /// The signal that any rank of `comm` has a note of, 0 for none; the same on every rank. Collective.
  [[nodiscard]] int agreed(MPI_Comm comm) const;

  static constexpr std::array<int, 4> kinds = {SIGTERM, SIGINT, SIGHUP, SIGXCPU};

private:
  std::array<struct sigaction, kinds.size()> before_{};
};

/// "SIGTERM"
std::string signal_name(int signal);

/// Runs `work` on groups of ranks of `comm` until it ends, or until a signal: `work` calls what it is given
/// after every step, with the communicator of its group. Throws Stopped on every rank after a signal, with
/// the text that `message` makes of its name. Collective.
void run_until_signal(MPI_Comm comm, const std::function<void(const std::function<void(MPI_Comm)>&)>& work,
                      const std::function<std::string(const std::string& signal)>& message);

} // namespace undula::apps
