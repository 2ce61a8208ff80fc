// The page of the explorer: files of apps/explorer/page/, as they were when the program was built.
#pragma once

#include <span>
#include <string_view>

namespace undula::apps {

struct PageFile {
  const char* path; ///< of the request
  const char* type;
  std::string_view text;
};

std::span<const PageFile> explorer_page();

} // namespace undula::apps
