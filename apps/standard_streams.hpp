// stdin, stdout and stderr of the process: results may not get lost on their way out.
#pragma once

namespace undula::apps {

/// Makes sure that 0, 1 and 2 are open, so that no file the program opens takes their place and gets what is
/// printed; and that a limit on the size of files (ulimit -f) is an error of writing instead of a signal. To
/// be called first.
void open_standard_streams();

/// Flushes stdout. Throws NumericsError where not all of it could be written.
void check_stdout();

} // namespace undula::apps
