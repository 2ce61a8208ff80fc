// undula explore MODEL.h5 [OTHER.h5 ...]: a page on this machine to move through the curves of models.
//   undula explore data/models/wave_pump_fixed.h5
//   undula explore pump.h5 other.h5
//   undula explore pump.h5 --data data/measured/corwave_120hz_0.53mm.csv --port 8765
#include <iostream>
#include <memory>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/explorer/explorer_server.hpp"
#include "apps/mpi_session.hpp"

namespace undula::apps {
namespace {

struct ExploreOptions {
  std::vector<std::string> models;
  std::vector<std::string> data;
  int port = 0;
};

} // namespace

void add_explore_command(CLI::App& app) {
  auto options = std::make_shared<ExploreOptions>();
  CLI::App* command =
      app.add_subcommand("explore", "Page on this machine to move through the curves of models");
  command
      ->add_option("models", options->models,
                   "reduced models or emulators (HDF5) made by undula train: one to ask, others to compare")
      ->required();
  command
      ->add_option("--data", options->data, "measured points (CSV) to show beside the curve, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--port", options->port, "port of 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535));
  command->callback([options] {
    if (is_first_process()) {
      serve_explorer(Exploration(options->models, options->data), options->port, [](int port) {
        std::cout << "http://127.0.0.1:" << port << "/" << std::endl; // now, whoever reads it
      });
    }
  });
}

} // namespace undula::apps
