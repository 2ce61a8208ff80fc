// The worked example of docs/writing_a_scene.md: its pieces make the shipped scene, its commands run.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/scene/scene_file.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

const std::string root = UNDULA_SOURCE_DIR;

/// The lines from "## A worked example" to the next section.
std::vector<std::string> example() {
  std::istringstream page(text_of(root + "/docs/writing_a_scene.md"));
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) {
      inside = line == "## A worked example";
    } else if (inside) {
      lines.push_back(line);
    }
  }
  return lines;
}

TEST(WritingAScene, ThePiecesAreTheShippedScene) {
  std::string text;
  bool inside = false;
  for (const std::string& line : example()) {
    if (line.starts_with("```")) {
      inside = line == "```toml";
    } else if (inside) {
      text += line + "\n";
    }
  }
  const Scene pieces = parse_scene(text, "docs/writing_a_scene.md", root);
  EXPECT_EQ(scene_to_toml(pieces), scene_to_toml(read_scene(root + "/data/scenes/flap_in_channel.toml")));
}

TEST(WritingAScene, TheCommandsRun) {
  const ScratchFolder folder;
  int commands = 0;
  for (const std::string& line : example()) {
    if (!line.starts_with("    undula ")) {
      continue;
    }
    std::istringstream words(line.substr(std::string("    undula ").size()));
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) {
      arguments.push_back(word.starts_with("data/") ? root + "/" + word : word);
    }
    const Outcome outcome = run_undula(arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << line << "\n" << outcome.err;
    ++commands;
  }
  EXPECT_GE(commands, 3);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "flap" / "speed.png"));
  // The couplings agree within a tenth, as the page says, and the flap bends at all.
  const auto mean = [&](const std::string& run) {
    std::istringstream table(text_of(folder.path() / run / "statistics.csv"));
    for (std::string line; std::getline(table, line);) {
      std::istringstream cells(line);
      std::string name, last, value;
      std::getline(cells, name, ',');
      std::getline(cells, last, ',');
      std::getline(cells, value, ',');
      if (name == "tip_displacement_x_mm") {
        return std::stod(value);
      }
    }
    return 0.0;
  };
  EXPECT_NEAR(mean("flap"), 0.51, 0.02);
  EXPECT_NEAR(mean("flap_mapped") / mean("flap"), 1, 0.1);
}

} // namespace
} // namespace undula::apps
