// Runs the undula binary in a folder of its own and keeps what it printed.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace undula::apps {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// An empty folder that goes with its owner.
class ScratchFolder {
public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "undula_apps_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

struct Outcome {
  int exit_code = -1;
  std::string out; ///< stdout
  std::string err; ///< stderr
};

/// Runs `undula words...` with `folder` as working directory. Words may not hold single quotes.
inline Outcome run_undula(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  const ScratchFolder streams;
  std::string command = "cd '" + folder.string() + "' && '" UNDULA_BINARY "'";
  for (const std::string& word : words) {
    command += " '" + word + "'";
  }
  const auto out = streams.path() / "out";
  const auto err = streams.path() / "err";
  command += " >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

inline int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

/// The texts that a message about a file of the corpus has to hold: "# expect: a | b" in its first line.
inline std::vector<std::string> expected_texts(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::string mark = "# expect: ";
  std::vector<std::string> texts;
  if (!line.starts_with(mark)) {
    return texts;
  }
  line += " | ";
  for (std::size_t begin = mark.size(); begin < line.size();) {
    const auto end = line.find(" | ", begin);
    texts.push_back(line.substr(begin, end - begin));
    begin = end + 3;
  }
  return texts;
}

/// Files of a folder of tests/data, sorted.
inline std::vector<std::filesystem::path> corpus(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(UNDULA_SOURCE_DIR "/tests/data/" + folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace undula::apps
