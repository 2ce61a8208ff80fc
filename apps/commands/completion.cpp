// undula completion bash|zsh: a script that completes commands, options and keys of scenes.
//   source <(undula completion bash)
//   source <(undula completion zsh)
#include <iostream>
#include <memory>
#include <string>

#include "apps/commands/commands.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/shell_completion.hpp"

namespace undula::apps {

void add_completion_command(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "Script that completes the command line in a shell (docs/using.md)");
  command->add_option("shell", *shell, "the shell")->required()->check(CLI::IsMember({"bash", "zsh"}));
  command->callback([shell, &app] {
    if (is_first_process()) {
      std::cout << (*shell == "bash" ? bash_completion(app) : zsh_completion(app));
    }
  });
}

} // namespace undula::apps
