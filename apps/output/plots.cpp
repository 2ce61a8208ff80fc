#include "apps/output/plots.hpp"

#include <cstdio>

#include "apps/output/gnuplot.hpp"

namespace undula::apps {
namespace {

/// "a b" or "a b c" on one line.
template <typename... Numbers>
std::string row(Numbers... numbers) {
  std::string text;
  char number[32];
  ((std::snprintf(number, sizeof number, "%.9g ", numbers), text += number), ...);
  text.back() = '\n';
  return text;
}

/// Blocks of a data file, found by their index.
class DataBlocks {
public:
  /// Starts a block; what follows by `add` belongs to it. Returns its index.
  int begin(const std::string& comment) {
    text_ += (count_ == 0 ? "# " : "\n\n# ") + comment + "\n";
    return count_++;
  }
  void add(const std::string& lines) { text_ += lines; }
  [[nodiscard]] const std::string& text() const { return text_; }

private:
  std::string text_;
  int count_ = 0;
};

std::string plot_item(int block, const std::string& style, const std::string& label) {
  return "data index " + std::to_string(block) + " " + style +
         (label.empty() ? " notitle" : " title " + gnuplot_string(label));
}

std::string plot_command(const char* command, const std::vector<std::string>& items) {
  std::string text = command;
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += (i == 0 ? " \\\n  " : ", \\\n  ") + items[i];
  }
  return text + "\n";
}

std::string axes(const std::string& title, const std::string& x_label, const std::string& y_label) {
  return "set title " + gnuplot_string(title) + "\nset xlabel " + gnuplot_string(x_label) + "\nset ylabel " +
         gnuplot_string(y_label) + "\n";
}

} // namespace

bool plot_hq_curves(const std::filesystem::path& picture, const std::string& title,
                    std::span<const HqLine> lines, std::span<const HqPoints> point_sets) {
  struct Colours {
    const char *line, *band;
  };
  constexpr std::array colours = {Colours{"#1f4e8c", "#b0c4de"}, Colours{"#c0392b", "#edbbb4"},
                                  Colours{"#27853f", "#b8dcc0"}, Colours{"#8e44ad", "#d7bfe3"}};
  DataBlocks blocks;
  std::vector<std::string> items;

  // 1. The bands, as closed polygons: up along flow - error, down along flow + error.
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const HqLine& line = lines[k];
    const std::size_t n = line.head_mmHg.size();
    if (line.error_l_per_min.empty()) {
      continue;
    }
    const int band = blocks.begin("band: flow (l/min), head (mmHg)");
    for (std::size_t i = 0; i < n; ++i) {
      blocks.add(row(line.flow_l_per_min[i] - line.error_l_per_min[i], line.head_mmHg[i]));
    }
    for (std::size_t i = n; i-- > 0;) {
      blocks.add(row(line.flow_l_per_min[i] + line.error_l_per_min[i], line.head_mmHg[i]));
    }
    items.push_back(plot_item(band,
                              std::string("with filledcurves closed fs transparent solid 0.7 fc rgb '") +
                                  colours[k % colours.size()].band + "'",
                              line.band_label));
  }

  // 2. The lines.
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const int curve = blocks.begin("curve: flow (l/min), head (mmHg)");
    for (std::size_t i = 0; i < lines[k].head_mmHg.size(); ++i) {
      blocks.add(row(lines[k].flow_l_per_min[i], lines[k].head_mmHg[i]));
    }
    items.push_back(
        plot_item(curve, std::string("with lines lw 2 lc rgb '") + colours[k % colours.size()].line + "'",
                  lines[k].label));
  }

  // 3. The points and further curves.
  const std::array styles = {"pt 6 ps 1 lc rgb '#c0392b'", "pt 7 ps 1.2 lc rgb '#1f4e8c'",
                             "pt 4 ps 1.2 lc rgb '#27853f'"};
  std::size_t set = 0;
  for (const HqPoints& points : point_sets) {
    if (points.head_mmHg.empty()) {
      continue;
    }
    const int block = blocks.begin("points: flow (l/min), head (mmHg)");
    for (std::size_t i = 0; i < points.head_mmHg.size(); ++i) {
      blocks.add(row(points.flow_l_per_min[i], points.head_mmHg[i]));
    }
    const std::string of_line =
        points.line < 0 ? ""
                        : std::string(" lc rgb '") +
                              colours[static_cast<std::size_t>(points.line) % colours.size()].line + "'";
    if (points.as_curve) {
      items.push_back(plot_item(
          block, "with lines lw 2 dt 2" + (of_line.empty() ? " lc rgb '#8e44ad'" : of_line), points.label));
    } else {
      items.push_back(plot_item(block,
                                "with points " + (of_line.empty() ? std::string(styles[set++ % styles.size()])
                                                                  : "pt 6 ps 1" + of_line),
                                points.label));
    }
  }
  const std::string commands =
      axes(title, "flow (l/min)", "head (mmHg)") +
      (lines.size() > 1 ? "set grid\nset key top right\n" : "set grid\nset key bottom left\n") +
      plot_command("plot", items);
  return draw_picture(picture, blocks.text(), commands);
}

bool plot_lines(const std::filesystem::path& picture, const std::string& title, const std::string& x_label,
                const std::string& y_label, std::span<const Line> lines) {
  DataBlocks blocks;
  std::vector<std::string> items;
  for (const Line& line : lines) {
    const int block = blocks.begin(x_label + ", " + y_label);
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      blocks.add(row(line.x[i], line.y[i]));
    }
    items.push_back(plot_item(block, "with lines lw 2", line.label));
  }
  const std::string commands =
      axes(title, x_label, y_label) + "set grid\nset key outside right top\n" + plot_command("plot", items);
  return draw_picture(picture, blocks.text(), commands);
}

constexpr const char* palette =
    "set palette defined (0 '#352a87', 1 '#0868c6', 2 '#06a7c6', 3 '#7bbf6a', 4 '#f9c932', 5 '#f9fb0e')\n";

bool plot_field(const std::filesystem::path& picture, const std::string& title, const FieldOnTriangles& field,
                std::span<const std::vector<Eigen::Vector2d>> outlines) {
  // 1. Every triangle as a block of its own: a quadrilateral with two corners in one, which pm3d fills.
  const std::string place = std::string(field.axes[0]) + ", " + field.axes[1];
  std::string data = "# blocks of triangles: " + place + ", " + field.label + "\n";
  for (const auto& triangle : field.triangles) {
    double mean = 0;
    for (const int point : triangle) {
      mean += field.values[static_cast<std::size_t>(point)] / 3;
    }
    std::array<std::string, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d& x = field.points[static_cast<std::size_t>(triangle[i])];
      corners[i] = row(x[0], x[1], mean);
    }
    data += corners[0] + corners[1] + "\n" + corners[2] + corners[2] + "\n\n";
  }
  const std::string last_triangle = std::to_string(field.triangles.size() - 1);
  std::vector<std::string> items = {"data index 0:" + last_triangle + " using 1:2:3 with pm3d notitle"};

  // 2. Outlines over the triangles, each a block of its own: lines in one block that have equal numbers of
  // points would be joined as a grid.
  if (!outlines.empty()) {
    for (const auto& outline : outlines) {
      data += "# outline: " + place + "\n";
      for (const Eigen::Vector2d& x : outline) {
        data += row(x[0], x[1]);
      }
      data += "\n\n";
    }
    items.push_back("data index " + std::to_string(field.triangles.size()) + ":" +
                    std::to_string(field.triangles.size() + outlines.size() - 1) +
                    " using 1:2:(0) with lines lc rgb 'black' lw 1 notitle");
  }

  // 3. Seen from above, equal scales, colours that stay readable in grey.
  const std::string commands = axes(title, field.axes[0], field.axes[1]) +
                               "set view map\nset size ratio -1\nset pm3d corners2color c1\n" + palette +
                               "set autoscale fix\nset cblabel " + gnuplot_string(field.label) + "\n" +
                               plot_command("splot", items);
  return draw_picture(picture, data, commands);
}

bool plot_pieces(const std::filesystem::path& picture, const std::string& title,
                 const ColouredPieces& coloured, std::span<const std::vector<Eigen::Vector2d>> outlines) {
  std::string data = "# pieces: r (cm), z (cm), " + coloured.label + "\n";
  for (std::size_t i = 0; i < coloured.pieces.size(); ++i) {
    for (const Eigen::Vector2d& x : coloured.pieces[i]) {
      data += row(x[0], x[1], coloured.values[i]);
    }
    data += "\n";
  }
  std::vector<std::string> items = {"data index 0 using 1:2:3 with lines lc palette lw 4 notitle"};
  if (!outlines.empty()) {
    data += "\n# outlines: r (cm), z (cm)\n";
    for (const auto& outline : outlines) {
      for (const Eigen::Vector2d& x : outline) {
        data += row(x[0], x[1]);
      }
      data += "\n";
    }
    items.emplace_back("data index 1 using 1:2 with lines lc rgb 'black' lw 1 notitle");
  }
  const std::string commands = axes(title, "r (cm)", "z (cm)") + "set size ratio -1\n" + palette +
                               "set cblabel " + gnuplot_string(coloured.label) + "\n" +
                               plot_command("plot", items);
  return draw_picture(picture, data, commands);
}

} // namespace undula::apps
