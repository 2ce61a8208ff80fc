#include "apps/stop_signal.hpp"

namespace undula::apps {
namespace {

volatile std::sig_atomic_t noted = 0; // a handler can reach nothing else

void note(int signal) { noted = signal; }

} // namespace

StopSignal::StopSignal() {
  noted = 0;
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    sigaction(kinds[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) {
      sigaction(kinds[i], &action, nullptr);
    }
  }
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    sigaction(kinds[i], &before_[i], nullptr);
  }
}

int StopSignal::agreed(MPI_Comm comm) const {
  int signal = noted;
  MPI_Allreduce(MPI_IN_PLACE, &signal, 1, MPI_INT, MPI_MAX, comm);
  return signal;
}

std::string signal_name(int signal) {
  switch (signal) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGHUP:
      return "SIGHUP";
    case SIGXCPU:
      return "SIGXCPU";
    default:
      return "signal " + std::to_string(signal);
  }
}

void run_until_signal(MPI_Comm comm, const std::function<void(const std::function<void(MPI_Comm)>&)>& work,
                      const std::function<std::string(const std::string& signal)>& message) {
  const StopSignal stop;
  int stopped = 0;
  try {
    work([&](MPI_Comm group) {
      if (const int signal = stop.agreed(group); signal != 0) {
        throw Stopped(signal_name(signal));
      }
    });
  } catch (const Stopped&) {
    stopped = 1;
  }
  // Groups of ranks may have been told at different times; here they meet.
  MPI_Allreduce(MPI_IN_PLACE, &stopped, 1, MPI_INT, MPI_MAX, comm);
  if (stopped != 0) {
    throw Stopped(message(signal_name(stop.agreed(comm))));
  }
}

} // namespace undula::apps
