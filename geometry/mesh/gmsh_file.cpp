#include "geometry/mesh/gmsh_file.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

/// Larger integers are no tags or counts; all up to here are exact as double and fit into an int.
constexpr double greatest_tag = 2147483647.0;

/// Words of a text file with the line they stand on.
class Words {
public:
  explicit Words(std::filesystem::path file) : file_(std::move(file)) {
    if (!std::filesystem::is_regular_file(file_))
      throw InputError("the mesh cannot be read", "no such file", "a Gmsh file (.msh)", file_.string());
    std::ifstream in(file_, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    text_ = all.str();
  }

  int line() const { return line_; }
  std::string where() const { return file_.string() + ":" + std::to_string(line_); }

  [[noreturn]] void fail(const std::string& what, const std::string& seen, const std::string& allowed) const {
    throw InputError(what, seen, allowed, where());
  }

  /// Next word, empty at the end of the file.
  std::string word() {
    skip_space();
    const auto begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// Next text between double quotes.
  std::string quoted() {
    skip_space();
    const auto end = at_ < text_.size() && text_[at_] == '"' ? text_.find('"', at_ + 1) : std::string::npos;
    if (end == std::string::npos)
      fail("the mesh file has a broken physical name", word(), "a name in double quotes");
    const auto name = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return name;
  }

  double number() {
    const auto next = word();
    char* end = nullptr;
    const double value = std::strtod(next.c_str(), &end);
    if (next.empty()) fail("the mesh file is truncated", "end of file", "a number");
    if (*end != '\0') fail("the mesh file is broken", "'" + next.substr(0, 40) + "'", "a number");
    return value;
  }

  long integer() {
    const double value = number();
    if (!(std::abs(value) <= greatest_tag) || value != std::trunc(value))
      fail("the mesh file is broken", std::to_string(value), "an integer");
    return static_cast<long>(value);
  }

  long count() {
    const long value = integer();
    if (value < 0) fail("the mesh file is broken", std::to_string(value), "a count >= 0");
    return value;
  }

  void expect(const std::string& keyword) {
    if (const auto next = word(); next != keyword)
      fail(next.empty() ? "the mesh file is truncated" : "the mesh file is broken",
           next.empty() ? "end of file" : "'" + next.substr(0, 40) + "'", keyword);
  }

  void skip_section(const std::string& section) {
    for (auto next = word(); next != "$End" + section; next = word())
      if (next.empty()) fail("the mesh file is truncated", "end of file", "$End" + section);
  }

private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void skip_space() {
    for (; at_ < text_.size() && is_space(text_[at_]); ++at_)
      if (text_[at_] == '\n') ++line_;
  }

  std::filesystem::path file_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class Parser {
public:
  explicit Parser(const std::filesystem::path& file) : words_(file) {}

  GmshFile parse() {
    read_format();
    bool nodes = false, elements = false;
    for (auto next = words_.word(); !next.empty(); next = words_.word()) {
      if (next.front() != '$')
        words_.fail("the mesh file is broken", "'" + next.substr(0, 40) + "'", "a $Section");
      const auto section = next.substr(1);
      if (section == "PhysicalNames") {
        read_physical_names();
      } else if (section == "Entities" && version_4_) {
        read_entities();
      } else if (section == "Nodes") {
        version_4_ ? read_nodes_4() : read_nodes_2();
        nodes = true;
      } else if (section == "Elements") {
        version_4_ ? read_elements_4() : read_elements_2();
        elements = true;
      } else if (section == "PartitionedEntities") {
        words_.fail("the mesh file is partitioned", "$PartitionedEntities", "a mesh in one piece");
      } else {
        words_.skip_section(section);
        continue;
      }
      words_.expect("$End" + section);
    }
    if (!nodes || !elements)
      words_.fail("the mesh file is truncated", nodes ? "no $Elements" : "no $Nodes", "$Nodes and $Elements");
    return std::move(content_);
  }

private:
  void read_format() {
    if (words_.word() != "$MeshFormat")
      words_.fail("this is not a Gmsh file", "another beginning", "$MeshFormat on the first line");
    const auto version = words_.word();
    const auto type = words_.word();
    const auto size = words_.word();
    if (version != "2.2" && version != "4.1")
      words_.fail("unknown version of the Gmsh format", "'" + version.substr(0, 40) + "'", "2.2 or 4.1");
    if (type != "0")
      words_.fail("the mesh file is binary", "file type " + type.substr(0, 40), "ASCII, file type 0");
    version_4_ = version == "4.1";
    words_.expect("$EndMeshFormat");
  }

  void read_physical_names() {
    for (long n = words_.count(); n > 0; --n) {
      const int dimension = static_cast<int>(words_.integer());
      const int tag = static_cast<int>(words_.integer());
      content_.physical_names[{dimension, tag}] = words_.quoted();
    }
  }

  void read_entities() {
    std::array<long, 4> counts{};
    for (auto& n : counts) n = words_.count();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (long k = 0; k < counts[dimension]; ++k) {
        const long tag = words_.integer();
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) words_.number(); // position or bounding box
        auto& groups = entity_physical_[{dimension, tag}];
        // A group that holds an entity against its orientation has a negative tag.
        for (long n = words_.count(); n > 0; --n)
          groups.push_back(std::abs(static_cast<int>(words_.integer())));
        if (dimension > 0)
          for (long n = words_.count(); n > 0; --n) words_.integer(); // bounding entities
      }
  }

  void read_node(long tag) {
    Point<3> x;
    for (int i = 0; i < 3; ++i) x[i] = words_.number();
    if (!x.allFinite())
      words_.fail("the mesh file is broken", "node " + std::to_string(tag), "finite coordinates");
    if (!content_.nodes.emplace(tag, x).second)
      words_.fail("the mesh file is broken", "node " + std::to_string(tag) + " twice", "distinct node tags");
  }

  void read_nodes_2() {
    for (long n = words_.count(); n > 0; --n) read_node(words_.integer());
  }

  void read_nodes_4() {
    const long blocks = words_.count();
    for (int i = 0; i < 3; ++i) words_.count(); // nodes, least and greatest tag
    for (long block = 0; block < blocks; ++block) {
      const long dimension = words_.integer();
      words_.integer(); // entity
      const bool parametric = words_.integer() != 0;
      std::vector<long> tags;
      for (long n = words_.count(); n > 0; --n) tags.push_back(words_.integer());
      for (const long tag : tags) {
        read_node(tag);
        for (long i = 0; parametric && i < dimension; ++i) words_.number();
      }
    }
  }

  void read_element(int type, std::vector<int> physical) {
    GmshElement element{type, {}, std::move(physical), words_.line()};
    const int dimension = gmsh_simplex_dimension(type);
    for (int i = 0; i <= dimension; ++i) {
      element.nodes.push_back(words_.integer());
      if (!content_.nodes.contains(element.nodes.back()))
        words_.fail("an element has an unknown node", std::to_string(element.nodes.back()),
                    "a tag of $Nodes");
    }
    content_.elements.push_back(std::move(element));
  }

  int read_type() {
    const int type = static_cast<int>(words_.integer());
    if (gmsh_simplex_dimension(type) < 0)
      words_.fail("an element is not a linear simplex", "Gmsh element type " + std::to_string(type),
                  "1 (segment), 2 (triangle), 4 (tetrahedron), 15 (point)");
    return type;
  }

  void read_elements_2() {
    for (long n = words_.count(); n > 0; --n) {
      words_.integer(); // tag
      const int type = read_type();
      std::vector<int> tags;
      for (long k = words_.count(); k > 0; --k) tags.push_back(static_cast<int>(words_.integer()));
      std::vector<int> physical;
      if (!tags.empty() && tags.front() != 0) physical.push_back(std::abs(tags.front())); // 0: in no group
      read_element(type, std::move(physical));
    }
  }

  void read_elements_4() {
    const long blocks = words_.count();
    for (int i = 0; i < 3; ++i) words_.count(); // elements, least and greatest tag
    for (long block = 0; block < blocks; ++block) {
      const int dimension = static_cast<int>(words_.integer());
      const long entity = words_.integer();
      const int type = read_type();
      const auto groups = entity_physical_.find({dimension, entity});
      for (long n = words_.count(); n > 0; --n) {
        words_.integer(); // tag
        read_element(type, groups == entity_physical_.end() ? std::vector<int>{} : groups->second);
      }
    }
  }

  Words words_;
  bool version_4_ = false;
  std::map<std::pair<int, long>, std::vector<int>> entity_physical_; ///< (dimension, entity) -> groups
  GmshFile content_;
};

} // namespace

int gmsh_simplex_dimension(int type) {
  switch (type) {
    case 15:
      return 0;
    case 1:
      return 1;
    case 2:
      return 2;
    case 4:
      return 3;
    default:
      return -1;
  }
}

GmshFile read_gmsh_file(const std::filesystem::path& file) { return Parser(file).parse(); }

} // namespace undula::geometry
