#include "apps/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "rom/base/error.hpp"

namespace undula::apps {

void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // Reading only: what is written to a closed stdout fails, as it should. open() takes the lowest number.
    const int mode = descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY;
    if (fcntl(descriptor, F_GETFD) == -1 && open("/dev/null", mode) != descriptor) {
      return;
    }
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void check_stdout() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  const int reason = errno;
  if (flushed && std::cout && std::ferror(stdout) == 0) {
    return;
  }
  throw NumericsError(
      "the results could not be printed",
      "stdout: " + std::string(reason != 0 ? std::strerror(reason) : "an earlier write failed"),
      "a disk with free space for what is redirected; files in folders are complete");
}

} // namespace undula::apps
