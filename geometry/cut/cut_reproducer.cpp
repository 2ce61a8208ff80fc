#include "geometry/cut/cut_reproducer.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

constexpr const char* header = "undula-cut-reproducer";

template <int dim>
SimplexMesh<dim> submesh(const SimplexMesh<dim>& mesh, std::span<const int> cells) {
  SimplexMesh<dim> sub;
  std::map<int, int> local;
  for (const int cell : cells) {
    auto& points = sub.cells.emplace_back();
    for (int i = 0; i <= dim; ++i) {
      const int p = mesh.cells[cell][i];
      const auto [entry, is_new] = local.try_emplace(p, static_cast<int>(sub.points.size()));
      if (is_new) sub.points.push_back(mesh.points[p]);
      points[i] = entry->second;
    }
  }
  return sub;
}

template <int dim>
void write_mesh(std::ostream& out, const char* name, const SimplexMesh<dim>& mesh) {
  out << name << ' ' << mesh.points.size() << ' ' << mesh.cells.size() << '\n';
  for (const auto& point : mesh.points) {
    for (int i = 0; i < dim; ++i) {
      char text[40];
      std::snprintf(text, sizeof text, "%a", point[i]);
      out << (i ? " " : "") << text;
    }
    out << '\n';
  }
  for (const auto& cell : mesh.cells)
    for (int i = 0; i <= dim; ++i) out << cell[i] << (i < dim ? ' ' : '\n');
}

class Reader {
public:
  explicit Reader(const std::string& path) : path_(path), in_(path) {
    if (!in_) fail("the file cannot be opened");
  }

  std::string word() {
    std::string text;
    if (!(in_ >> text)) fail("the file ends early");
    return text;
  }
  void expect(const std::string& wanted) {
    if (const auto seen = word(); seen != wanted) fail("'" + seen + "' instead of '" + wanted + "'");
  }
  int integer(int lowest, int highest) {
    const auto text = word();
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (*end != '\0' || value < lowest || value > highest)
      fail("'" + text + "' where a count or index stands");
    return static_cast<int>(value);
  }
  double real() {
    const auto text = word();
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end); // streams do not read hexadecimal floats
    if (*end != '\0' || !std::isfinite(value)) fail("'" + text + "' where a coordinate stands");
    return value;
  }

  template <int dim>
  SimplexMesh<dim> mesh(const std::string& name) {
    constexpr int most = 1 << 24;
    SimplexMesh<dim> mesh;
    expect(name);
    const int n_points = integer(0, most);
    const int n_cells = integer(0, most);
    for (int p = 0; p < n_points; ++p) {
      Point<dim> point;
      for (int i = 0; i < dim; ++i) point[i] = real();
      mesh.points.push_back(point);
    }
    for (int c = 0; c < n_cells; ++c) {
      std::array<int, dim + 1> cell;
      for (int& p : cell) p = integer(0, n_points - 1);
      mesh.cells.push_back(cell);
    }
    return mesh;
  }

private:
  [[noreturn]] void fail(const std::string& seen) {
    throw InputError("this is no reproducer of a cut", seen, "a file written when a cut failed", path_);
  }

  std::string path_;
  std::ifstream in_;
};

} // namespace

template <int dim>
CutReproducer<dim> make_reproducer(const SimplexMesh<dim>& background, int cell,
                                   std::span<const SimplexMesh<dim>> solids,
                                   std::span<const SolidCell> solid_cells, const CutOptions& options) {
  CutReproducer<dim> reproducer{submesh<dim>(background, {&cell, 1}), {}, options};
  for (int s = 0; s < static_cast<int>(solids.size()); ++s) {
    std::vector<int> cells;
    for (const auto& solid_cell : solid_cells)
      if (solid_cell.solid == s) cells.push_back(solid_cell.cell);
    reproducer.solids.push_back(submesh<dim>(solids[s], cells));
  }
  return reproducer;
}

template <int dim>
void write_reproducer(const CutReproducer<dim>& reproducer, const std::string& path) {
  const std::string temporary = path + ".part";
  {
    std::ofstream out(temporary);
    out << header << " 1\ndimension " << dim << "\ndegrees " << reproducer.options.volume_degree << ' '
        << reproducer.options.interface_degree << ' ' << reproducer.options.boundary_degree << '\n';
    write_mesh(out, "background", reproducer.background);
    out << "solids " << reproducer.solids.size() << '\n';
    for (const auto& solid : reproducer.solids) write_mesh(out, "solid", solid);
    if (!out.flush())
      throw NumericsError("a cut failed, and its reproducer cannot be written", path, "a writable directory");
  }
  std::filesystem::rename(temporary, path);
}

template <int dim>
CutReproducer<dim> read_reproducer(const std::string& path) {
  Reader in(path);
  in.expect(header);
  in.expect("1");
  in.expect("dimension");
  in.expect(std::to_string(dim));
  CutReproducer<dim> reproducer;
  in.expect("degrees");
  for (int* degree : {&reproducer.options.volume_degree, &reproducer.options.interface_degree,
                      &reproducer.options.boundary_degree})
    *degree = in.integer(0, 100);
  reproducer.background = in.mesh<dim>("background");
  in.expect("solids");
  const int n_solids = in.integer(0, 1 << 20);
  for (int s = 0; s < n_solids; ++s) reproducer.solids.push_back(in.mesh<dim>("solid"));
  return reproducer;
}

template <int dim>
CutMesh<dim> rerun_reproducer(const std::string& path) {
  auto reproducer = read_reproducer<dim>(path);
  reproducer.options.reproducer_directory = std::filesystem::path(path).parent_path().string();
  return cut_mesh<dim>(reproducer.background, reproducer.solids, reproducer.options);
}

#define UNDULA_INSTANTIATE(dim)                                                                    \
  template CutReproducer<dim> make_reproducer<dim>(const SimplexMesh<dim>&, int,                   \
                                                   std::span<const SimplexMesh<dim>>,              \
                                                   std::span<const SolidCell>, const CutOptions&); \
  template void write_reproducer<dim>(const CutReproducer<dim>&, const std::string&);              \
  template CutReproducer<dim> read_reproducer<dim>(const std::string&);                            \
  template CutMesh<dim> rerun_reproducer<dim>(const std::string&);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
