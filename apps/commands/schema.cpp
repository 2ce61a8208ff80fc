// undula schema: the JSON schema of scenes, for editors of TOML.
//   undula schema > undula.schema.json
#include <iostream>

#include "apps/commands/commands.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/scene_schema.hpp"

namespace undula::apps {

void add_schema_command(CLI::App& app) {
  app.add_subcommand("schema", "JSON schema of scenes, for editors of TOML (docs/writing_a_scene.md)")
      ->callback([] {
        if (is_first_process()) {
          std::cout << scene_schema().dump(2) << "\n";
        }
      });
}

} // namespace undula::apps
