// Completion of the command line in shells, made from the tree of commands and options itself.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace undula::apps {

/// A script for bash: `source <(undula completion bash)`.
std::string bash_completion(const CLI::App& app);

/// A script for zsh, to be sourced after compinit or kept as `_undula` in a folder of $fpath.
std::string zsh_completion(const CLI::App& app);

} // namespace undula::apps
