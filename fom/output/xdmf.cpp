#include "fom/output/xdmf.hpp"

#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string data_item(const std::string& extents, bool real, const std::string& source) {
  return "<DataItem Dimensions=\"" + extents + "\" NumberType=\"" + (real ? "Float" : "Int") +
         "\" Precision=\"" + (real ? "8" : "4") + "\" Format=\"HDF\">" + escaped(source) + "</DataItem>\n";
}

std::string mesh_text(const XdmfSeries& series, const XdmfStep& step) {
  const bool own = step.points > 0;
  const auto& file = own ? step.file : series.mesh_file;
  const auto cells = std::to_string(own ? step.cells : series.cells);
  return "        <Topology TopologyType=\"" + std::string(series.dim == 2 ? "Triangle" : "Tetrahedron") +
         "\" NumberOfElements=\"" + cells + "\">\n          " +
         data_item(cells + " " + std::to_string(series.dim + 1), false, file + ":/cells") +
         "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n          " +
         data_item(std::to_string(own ? step.points : series.points) + " 3", true, file + ":/points") +
         "        </Geometry>\n";
}

std::string field_text(const XdmfField& field, const XdmfStep& step, std::size_t points) {
  return "        <Attribute Name=\"" + escaped(field.name) + "\" AttributeType=\"" +
         (field.vector ? "Vector" : "Scalar") +
         "\" Center=\"Node\">\n          <Information Name=\"unit\" Value=\"" + escaped(field.unit) +
         "\"/>\n          " +
         data_item(std::to_string(points) + (field.vector ? " 3" : ""), true,
                   step.file + ":/fields/" + field.name) +
         "        </Attribute>\n";
}

} // namespace

std::string xdmf_text(const XdmfSeries& series) {
  const auto name = escaped(series.name);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n    <Grid Name=\"" +
      name + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& step : series.steps) {
    text += "      <Grid Name=\"" + name + "\" GridType=\"Uniform\">\n        <Time Value=\"" +
            exact_number(step.time) + "\"/>\n" + mesh_text(series, step);
    for (const auto& field : step.fields)
      text += field_text(field, step, step.points > 0 ? step.points : series.points);
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

} // namespace undula::fom
