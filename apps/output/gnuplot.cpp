#include "apps/output/gnuplot.hpp"

#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

/// Exit status of `gnuplot -e setting script` in a folder; 127 if gnuplot cannot be started.
int run_gnuplot(const std::filesystem::path& folder, const std::string& setting, const std::string& script) {
  std::array<std::string, 4> words = {"gnuplot", "-e", setting, script};
  std::array<char*, 5> arguments = {words[0].data(), words[1].data(), words[2].data(), words[3].data(),
                                    nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int failed = posix_spawnp(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    return 127;
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    return 126;
  }
  return WEXITSTATUS(status);
}

std::string first_line_of_script(const std::string& name) {
  return "# " + name + ".png: draw it again by `gnuplot " + name + ".gp`";
}

/// Script and data of a picture are named after it, which the user may not think of.
void refuse_files_of_others(const std::filesystem::path& picture) {
  const std::string name = picture.stem().string();
  const auto beside = [&](const char* ending) { return picture.parent_path() / (name + ending); };
  std::error_code ignored;
  const bool ours = std::filesystem::is_regular_file(beside(".gp"), ignored) &&
                    read_text_file(beside(".gp")).starts_with(first_line_of_script(name));
  for (const char* ending : {".gp", ".dat"}) {
    if (!ours && std::filesystem::exists(beside(ending), ignored)) {
      throw InputError("a picture brings its script and its data, and would replace a file of others",
                       '"' + beside(ending).string() + '"', "another name of the picture", "--plot");
    }
  }
}

} // namespace

std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    // The end of a line would end the text, and what follows would be a command.
    const auto code = static_cast<unsigned char>(c);
    quoted += c == '\'' ? "''" : std::string(1, code < 0x20 || code == 0x7f ? ' ' : c);
  }
  return quoted + "'";
}

void check_picture_name(const std::filesystem::path& picture) {
  for (const char c : picture.string()) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) {
      char seen[8];
      std::snprintf(seen, sizeof seen, "\\x%02x", code);
      throw InputError("the picture has a control character in its name", seen,
                       "a name that ends in .png, of characters that can be seen", "--plot");
    }
  }
  if (picture.extension() != ".png" || picture.stem().empty()) {
    throw InputError("the picture has a name of another format", '"' + picture.string() + '"',
                     "a name that ends in .png", "--plot");
  }
  if (!std::filesystem::is_directory(std::filesystem::absolute(picture).parent_path())) {
    throw InputError("the folder of the picture does not exist", '"' + picture.string() + '"',
                     "an existing folder", "--plot");
  }
  refuse_files_of_others(picture);
}

bool draw_picture(const std::filesystem::path& picture, const std::string& data,
                  const std::string& commands) {
  check_picture_name(picture);
  const std::filesystem::path full = std::filesystem::absolute(picture);
  const std::string name = full.stem().string();
  const std::string script = first_line_of_script(name) + "\n" +
                             "if (!exists('picture')) picture = " + gnuplot_string(name + ".png") + "\n" +
                             "data = " + gnuplot_string(name + ".dat") + "\n" +
                             "set terminal pngcairo noenhanced size 1000,700 font 'DejaVu Sans,13'\n" +
                             "set output picture\n" + commands;
  // The script first: it tells that the data are ours.
  replace_text_file(full.parent_path() / (name + ".gp"), script);
  replace_text_file(full.parent_path() / (name + ".dat"), data);

  const std::string partial = name + ".png.tmp";
  const int status = run_gnuplot(full.parent_path(), "picture = " + gnuplot_string(partial), name + ".gp");
  std::error_code error;
  if (status == 0) {
    std::filesystem::rename(full.parent_path() / partial, full, error);
  }
  if (status != 0 || error) {
    std::error_code ignored;
    std::filesystem::remove(full.parent_path() / partial, ignored);
    spdlog::warn("{} is not drawn: {}; its script {}.gp is kept", picture.string(),
                 status == 127 ? "gnuplot is not installed" : "gnuplot failed", name);
    return false;
  }
  return true;
}

} // namespace undula::apps
