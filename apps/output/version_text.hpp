// What `undula --version` prints.
#pragma once

#include <string>

namespace undula::apps {

/// Version and commit of Undula, then versions of the libraries that it computes with, one a line.
std::string version_text();

} // namespace undula::apps
