// undula new wave-pump|peristaltic-pump|general [FILE]: a commented scene to begin with.
//   undula new wave-pump pump.toml
//   undula new general flap.toml --all
#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/scene_templates.hpp"
#include "apps/mpi_session.hpp"
#include "fom/scene/commented_scene.hpp"
#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string kind, file;
  bool all_keys = false;
};

constexpr const char* wave_pump = "wave-pump";
constexpr const char* peristaltic_pump = "peristaltic-pump";
constexpr const char* general = "general";

std::string_view template_of(const std::string& kind) {
  return kind == wave_pump          ? wave_pump_template()
         : kind == peristaltic_pump ? peristaltic_pump_template()
                                    : general_template();
}

[[noreturn]] void refuse_existing(const fs::path& file) {
  throw InputError("a new scene takes the place of no file", "\"" + file.string() + "\" is there already",
                   "another name, or the file moved away", "undula new");
}

/// Writes a file that is not there yet; one that appears meanwhile stays as it is.
void write_new(const fs::path& file, std::string_view text) {
  std::FILE* stream = std::fopen(file.c_str(), "wx");
  if (stream == nullptr && errno == EEXIST) {
    refuse_existing(file);
  }
  if (stream == nullptr) {
    throw InputError("the file cannot be written", file.string() + ": " + std::strerror(errno),
                     "a folder that exists and may be written to", "undula new");
  }
  const bool whole = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (std::fclose(stream) != 0 || !whole) {
    std::error_code ignored;
    fs::remove(file, ignored);
    throw NumericsError("the file cannot be written whole", file.string(), "a disk with more space");
  }
}

void new_scene(const NewOptions& options) {
  if (!is_first_process()) {
    return;
  }
  // 1. Names that are free.
  const bool pump = options.kind == wave_pump;
  const fs::path file = options.file.empty() ? options.kind + ".toml" : options.file;
  if (file.extension() != ".toml" || file.filename().string().front() == '.') {
    throw InputError("the name of a scene ends with .toml", "\"" + file.string() + "\"",
                     "for instance pump.toml", "undula new");
  }
  fs::path profile = file;
  profile.replace_filename(file.stem().string() + "_profile.toml");
  for (const fs::path& name : {file, profile}) {
    if (fs::exists(fs::symlink_status(name)) && (name == file || pump)) {
      refuse_existing(name);
    }
  }

  // 2. The scene, and what it reads.
  CommentedSceneOptions scene;
  scene.all_keys = options.all_keys;
  scene.texts["name"] = file.stem().string();
  if (pump) {
    scene.texts["geometry.profile"] = profile.filename().string();
  }
  const std::string text = "# Every key is explained in docs/scene.md (`undula check --reference`).\n" +
                           commented_scene(template_of(options.kind), scene);
  if (pump) {
    write_new(profile, wave_pump_profile());
  }
  try {
    write_new(file, text);
  } catch (...) {
    std::error_code ignored;
    if (pump) {
      fs::remove(profile, ignored); // a profile alone is of no use
    }
    throw;
  }

  // 3. What to do with it.
  std::cout << file.string() << "\n" << (pump ? profile.string() + "\n" : "");
  spdlog::info("next: undula check {0}, then undula {1} {0}{2}", file.string(),
               options.kind == general ? "solve" : "hq",
               options.kind == general ? " --output run --plot" : "");
}

} // namespace

void add_new_command(CLI::App& app) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand("new", "Write a commented scene to begin with");
  command->add_option("kind", options->kind, "a pump, or a problem with a domain and bodies")
      ->required()
      ->check(CLI::IsMember({wave_pump, peristaltic_pump, general}));
  command->add_option("file", options->file, "scene to write (.toml), default: KIND.toml");
  command->add_flag("--all", options->all_keys, "also the keys that keep their defaults, commented out");
  command->callback([options] { new_scene(*options); });
}

} // namespace undula::apps
