// The page of the explorer: files of apps/explorer/page/, as they were when the program was built.
#pragma once

#include <string_view>

namespace undula::apps {

std::string_view explorer_html();
std::string_view explorer_script();
std::string_view explorer_style();

} // namespace undula::apps
