// Scenes, profiles and Gmsh meshes with a number, a line or a name changed at random: `undula check` accepts
// or refuses each, in less than ten seconds, and neither crashes nor fails in the numerics.
//   test_unit_apps --gtest_also_run_disabled_tests --gtest_filter='CheckFuzz.*Full'
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

#include "apps/apps.hpp"
#include "apps/input/scene_check.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

constexpr unsigned seconds_allowed = 10;

enum class Answer { accepted, refused, numerics, crashed, slow };

/// Checks a scene in a process of its own, so that a crash is an answer too.
Answer answer_to(const std::filesystem::path& scene) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(seconds_allowed);
    const rlimit memory = {rlim_t{4} << 30, rlim_t{4} << 30};
    setrlimit(RLIMIT_AS, &memory);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) {
      _exit(3);
    }
    try {
      check_scene(read_scene(scene));
    } catch (const InputError&) {
      _exit(2);
    } catch (const std::exception&) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    return WTERMSIG(status) == SIGALRM ? Answer::slow : Answer::crashed;
  }
  constexpr std::array answers = {Answer::accepted, Answer::numerics, Answer::refused};
  const int code = WEXITSTATUS(status);
  return code < 3 ? answers[static_cast<std::size_t>(code)] : Answer::crashed;
}

/// Changes one thing of a text.
class Mutator {
public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string change(std::string text) {
    switch (below(10)) {
      case 0:
        return drop_line(text);
      case 1:
        return repeat_line(text);
      case 2:
        return change_character(text);
      default:
        return change_number(text);
    }
  }

private:
  int below(std::size_t n) { return static_cast<int>(random_() % n); }

  std::string some_number(double before) {
    static const std::array<const char*, 14> odd = {"0",    "-1",   "1e300", "-1e300", "1e-300",
                                                    "nan",  "inf",  "1e12",  "1e-12",  "1e5",
                                                    "-0.0", "1e-6", "1000",  "1"};
    static const std::array<double, 10> factors = {-1, 0, 0.5, 2, 10, 0.1, 100, 0.01, 1.001, 3};
    if (below(3) == 0) {
      return odd[static_cast<std::size_t>(below(odd.size()))];
    }
    std::ostringstream number;
    number.precision(17);
    number << before * factors[static_cast<std::size_t>(below(factors.size()))];
    const std::string changed = number.str();
    return changed.find_first_of(".e") == std::string::npos ? changed + ".0" : changed;
  }

  std::string change_number(const std::string& text) {
    std::vector<std::pair<std::size_t, std::size_t>> numbers;
    for (std::size_t i = 0; i < text.size();) {
      const bool begins = (std::isdigit(static_cast<unsigned char>(text[i])) != 0 ||
                           (text[i] == '-' && i + 1 < text.size() &&
                            std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0)) &&
                          (i == 0 || std::string(" [,=(\n\"").find(text[i - 1]) != std::string::npos);
      if (!begins) {
        ++i;
        continue;
      }
      const std::size_t end = text.find_first_not_of("0123456789.eE+-", i);
      numbers.emplace_back(i, std::min(end, text.size()) - i);
      i = std::min(end, text.size());
    }
    if (numbers.empty()) {
      return text;
    }
    const auto [at, length] = numbers[static_cast<std::size_t>(below(numbers.size()))];
    std::string changed = text;
    return changed.replace(at, length, some_number(std::atof(text.substr(at, length).c_str())));
  }

  std::pair<std::size_t, std::size_t> some_line(const std::string& text) {
    const std::size_t at = static_cast<std::size_t>(below(text.size()));
    const std::size_t begin = text.rfind('\n', at);
    const std::size_t end = text.find('\n', at);
    return {begin == std::string::npos ? 0 : begin, end == std::string::npos ? text.size() : end};
  }
  std::string drop_line(std::string text) {
    const auto [begin, end] = some_line(text);
    return text.erase(begin, end - begin);
  }
  std::string repeat_line(std::string text) {
    const auto [begin, end] = some_line(text);
    return text.insert(end, text.substr(begin, end - begin));
  }
  std::string change_character(std::string text) {
    static const std::string some = "0123456789.-e\"'[]{}=,\n xyzrt#\\/";
    text[static_cast<std::size_t>(below(text.size()))] = some[static_cast<std::size_t>(below(some.size()))];
    return text;
  }

  std::mt19937 random_;
};

/// Runs `make(case)`, which writes a scene and gives its name, for as many cases; counts the answers.
void run_cases(const std::string& what, int count,
               const std::function<std::filesystem::path(int, Mutator&)>& make) {
  std::map<Answer, int> answers;
  double slowest = 0;
  for (int i = 0; i < count; ++i) {
    Mutator mutator(static_cast<unsigned>(7919 * i + 17));
    const auto scene = make(i, mutator);
    const auto begin = std::chrono::steady_clock::now();
    const Answer answer = answer_to(scene);
    slowest =
        std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    ++answers[answer];
    if (answer == Answer::crashed || answer == Answer::slow || answer == Answer::numerics) {
      const auto kept = std::filesystem::temp_directory_path() / ("undula_" + what + "_" + std::to_string(i));
      std::filesystem::remove_all(kept);
      std::filesystem::copy(scene.parent_path(), kept, std::filesystem::copy_options::recursive);
      ADD_FAILURE() << what << " " << i << " "
                    << (answer == Answer::crashed ? "crashes"
                        : answer == Answer::slow  ? "takes more than ten seconds"
                                                  : "fails in the numerics")
                    << ": " << kept / scene.filename();
    }
  }
  std::cout << what << ": " << count << " cases, " << answers[Answer::accepted] << " accepted, "
            << answers[Answer::refused] << " refused, " << answers[Answer::numerics] << " failed, "
            << answers[Answer::crashed] << " crashed, " << answers[Answer::slow] << " slow; slowest "
            << slowest << " s\n";
}

/// Shipped scenes, coarse where they are pumps.
void mutate_scenes(int count) {
  const ScratchFolder folder;
  const std::string data = UNDULA_SOURCE_DIR "/data";
  std::filesystem::create_directories(folder.path() / "scenes");
  std::filesystem::copy(data + "/profiles", folder.path() / "profiles");
  std::vector<std::string> scenes;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(data + "/scenes")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    scenes.push_back(text_of(file));
  }
  run_cases("scenes", count, [&](int i, Mutator& mutator) {
    const auto file = folder.path() / "scenes" / "scene.toml";
    std::ofstream(file) << mutator.change(scenes[static_cast<std::size_t>(i) % scenes.size()]);
    return file;
  });
}

void mutate_profiles(int count) {
  const ScratchFolder folder;
  const std::string data = UNDULA_SOURCE_DIR "/data";
  const std::string profile = text_of(data + "/profiles/wave_pump_profile.toml");
  for (const char* level : {"fixed", "thin_gap"}) {
    std::string scene = text_of(data + "/scenes/wave_pump_" + level + ".toml");
    const std::string name = "../profiles/wave_pump_profile.toml";
    scene.replace(scene.find(name), name.size(), "profile.toml");
    std::ofstream(folder.path() / (std::string(level) + ".toml")) << scene;
  }
  run_cases("profiles", count, [&](int i, Mutator& mutator) {
    std::ofstream(folder.path() / "profile.toml") << mutator.change(profile);
    return folder.path() / (i % 3 == 0 ? "thin_gap.toml" : "fixed.toml");
  });
}

/// A rectangle of squares, each in two, as a Gmsh file; sides "outlet", "shell", "inlet", `left`.
std::string gmsh_box(double left_r, double low, double right_r, double high, int columns, int rows,
                     const std::string& left) {
  const auto node = [&](int i, int j) { return std::to_string(j * (columns + 1) + i + 1); };
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"outlet\"\n1 2 \"shell\"\n1 3 "
          "\"inlet\"\n1 4 \""
       << left << "\"\n$EndPhysicalNames\n$Nodes\n"
       << (columns + 1) * (rows + 1) << "\n";
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      text << node(i, j) << " " << left_r + (right_r - left_r) * i / columns << " "
           << low + (high - low) * j / rows << " 0\n";
    }
  }
  std::vector<std::string> elements;
  for (int i = 0; i < columns; ++i) {
    elements.push_back("1 2 1 1 " + node(i, 0) + " " + node(i + 1, 0));
    elements.push_back("1 2 3 3 " + node(i, rows) + " " + node(i + 1, rows));
  }
  for (int j = 0; j < rows; ++j) {
    elements.push_back("1 2 2 2 " + node(columns, j) + " " + node(columns, j + 1));
    elements.push_back("1 2 4 4 " + node(0, j) + " " + node(0, j + 1));
    for (int i = 0; i < columns; ++i) {
      elements.push_back("2 2 9 9 " + node(i, j) + " " + node(i + 1, j) + " " + node(i + 1, j + 1));
      elements.push_back("2 2 9 9 " + node(i, j) + " " + node(i + 1, j + 1) + " " + node(i, j + 1));
    }
  }
  text << "$EndNodes\n$Elements\n" << elements.size() << "\n";
  for (std::size_t e = 0; e < elements.size(); ++e) {
    text << e + 1 << " " << elements[e] << "\n";
  }
  text << "$EndElements\n";
  return text.str();
}

void mutate_meshes(int count) {
  const ScratchFolder folder;
  const std::string fluid = gmsh_box(0, 0, 1, 2, 10, 20, "axis");
  const std::string solid = gmsh_box(0.3, 0.95, 0.9, 1.05, 12, 3, "tip");
  std::ofstream(folder.path() / "scene.toml") << R"toml(name = "meshes"
[geometry]
fluid_mesh = "fluid.msh"
solid_meshes = ["solid.msh"]
[fluid]
density_g_per_cm3 = 1.0
viscosity_poise = 0.035
[membrane]
density_g_per_cm3 = 1.125
young_dyn_per_cm2 = 1.686e7
poisson = 0.49
damping_time_s = 1e-4
clamp_radius_mm = 8.0
[operating_point]
frequency_Hz = 120.0
stroke_mm = 0.53
head_mmHg = 50.0
[mesh]
channel_size_mm = 0.8
membrane_size_mm = 0.4
)toml";
  run_cases("meshes", count, [&](int i, Mutator& mutator) {
    std::ofstream(folder.path() / "fluid.msh") << (i % 2 == 0 ? mutator.change(fluid) : fluid);
    std::ofstream(folder.path() / "solid.msh") << (i % 2 == 1 ? mutator.change(solid) : solid);
    return folder.path() / "scene.toml";
  });
}

TEST(CheckFuzz, Scenes) { mutate_scenes(100); }
TEST(CheckFuzz, Profiles) { mutate_profiles(30); }
TEST(CheckFuzz, Meshes) { mutate_meshes(20); }
TEST(CheckFuzz, DISABLED_ScenesFull) { mutate_scenes(1000); }
TEST(CheckFuzz, DISABLED_ProfilesFull) { mutate_profiles(300); }
TEST(CheckFuzz, DISABLED_MeshesFull) { mutate_meshes(200); }

} // namespace
} // namespace undula::apps
