#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "fom/output/field_writer.hpp"
#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/text_file.hpp"
#include "tests/unit/fom/io_folder.hpp"

namespace undula::fom {
namespace {

using boost::property_tree::ptree;

/// What a reader of XDMF sees of one <DataItem>: the numbers behind it, checked against what it announces.
struct Item {
  std::vector<std::size_t> extents;
  std::vector<double> values;
  std::string unit;
};

class FieldWriterTest : public FolderTest {
protected:
  /// The uniform grids of the temporal collection.
  std::vector<ptree> grids(const std::string& series) const {
    ptree document;
    boost::property_tree::read_xml((folder / (series + ".xdmf")).string(), document);
    EXPECT_EQ(document.get<std::string>("Xdmf.<xmlattr>.Version"), "3.0");
    const auto& collection = document.get_child("Xdmf.Domain.Grid");
    EXPECT_EQ(collection.get<std::string>("<xmlattr>.GridType"), "Collection");
    EXPECT_EQ(collection.get<std::string>("<xmlattr>.CollectionType"), "Temporal");
    std::vector<ptree> result;
    for (const auto& [tag, child] : collection)
      if (tag == "Grid") result.push_back(child);
    for (const auto& grid : result) EXPECT_EQ(grid.get<std::string>("<xmlattr>.GridType"), "Uniform");
    return result;
  }

  Item item(const ptree& parent) const {
    const auto& node = parent.get_child("DataItem");
    EXPECT_EQ(node.get<std::string>("<xmlattr>.Format"), "HDF");
    const auto source = node.get_value<std::string>();
    const auto colon = source.find(":/");
    const auto file = Hdf5File::open_read(folder / source.substr(0, colon));
    const auto dataset = source.substr(colon + 2);
    Item result;
    std::istringstream announced(node.get<std::string>("<xmlattr>.Dimensions"));
    for (std::size_t n; announced >> n;) result.extents.push_back(n);
    EXPECT_EQ(file.extents(dataset), result.extents) << source;
    result.unit = file.unit(dataset);
    const auto type = node.get<std::string>("<xmlattr>.NumberType");
    if (type == "Int") {
      EXPECT_EQ(node.get<int>("<xmlattr>.Precision"), 4);
      const auto values = file.read<int>(dataset);
      result.values.assign(values.begin(), values.end());
    } else {
      EXPECT_EQ(type, "Float");
      EXPECT_EQ(node.get<int>("<xmlattr>.Precision"), 8);
      result.values = file.read<double>(dataset);
    }
    return result;
  }

  static ptree attribute(const ptree& grid, const std::string& name) {
    for (const auto& [tag, child] : grid)
      if (tag == "Attribute" && child.get<std::string>("<xmlattr>.Name") == name) return child;
    ADD_FAILURE() << "no attribute " << name;
    return {};
  }

  std::size_t files_with(const std::string& part) const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      count += entry.path().filename().string().find(part) != std::string::npos;
    return count;
  }
};

FieldMesh<2> two_triangles() {
  FieldMesh<2> mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 0.5}, {1.0 / 3, 2}};
  mesh.cells = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

std::vector<NodalField> fields_at(int step) {
  NodalField velocity{"velocity", "cm/s", 2, {}}, pressure{"pressure", "dyn/cm^2", 1, {}};
  for (int i = 0; i < 4; ++i) {
    velocity.values.push_back(step + 0.1 * i);
    velocity.values.push_back(-step - 0.1 * i);
    pressure.values.push_back(std::exp(step) / (i + 1));
  }
  return {velocity, pressure};
}

TEST_F(FieldWriterTest, WritesWhatAnXdmfReaderNeeds) {
  auto writer = FieldWriter<2>::start(folder, "fluid", two_triangles(), {{"scene", "a < b & \"c\""}});
  EXPECT_TRUE(grids("fluid").empty());
  writer.write(0, 0, fields_at(0));
  writer.write(10, 1.0 / 30, fields_at(10));
  writer.sync();
  const auto times = grids("fluid");
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(std::stod(times[1].get<std::string>("Time.<xmlattr>.Value")), 1.0 / 30);
  for (const int k : {0, 1}) {
    const auto& grid = times[k];
    const auto& topology = grid.get_child("Topology");
    EXPECT_EQ(topology.get<std::string>("<xmlattr>.TopologyType"), "Triangle");
    EXPECT_EQ(topology.get<int>("<xmlattr>.NumberOfElements"), 2);
    EXPECT_EQ(item(topology).values, (std::vector<double>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(grid.get<std::string>("Geometry.<xmlattr>.GeometryType"), "XYZ");
    const auto points = item(grid.get_child("Geometry"));
    EXPECT_EQ(points.values, (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 0.5, 0, 1.0 / 3, 2, 0}));
    EXPECT_EQ(points.unit, "cm");

    const auto expected = fields_at(10 * k);
    const auto velocity = attribute(grid, "velocity");
    EXPECT_EQ(velocity.get<std::string>("<xmlattr>.AttributeType"), "Vector");
    EXPECT_EQ(velocity.get<std::string>("<xmlattr>.Center"), "Node");
    EXPECT_EQ(velocity.get<std::string>("Information.<xmlattr>.Value"), "cm/s");
    const auto vectors = item(velocity);
    EXPECT_EQ(vectors.unit, "cm/s");
    ASSERT_EQ(vectors.extents, (std::vector<std::size_t>{4, 3}));
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(vectors.values[3 * i], expected[0].values[2 * i]);
      EXPECT_EQ(vectors.values[3 * i + 1], expected[0].values[2 * i + 1]);
      EXPECT_EQ(vectors.values[3 * i + 2], 0);
    }
    const auto pressure = attribute(grid, "pressure");
    EXPECT_EQ(pressure.get<std::string>("<xmlattr>.AttributeType"), "Scalar");
    EXPECT_EQ(item(pressure).values, expected[1].values);
  }
  EXPECT_EQ(Hdf5File::open_read(folder / "fluid_10.h5").read_text("provenance/scene"), "a < b & \"c\"");
}

TEST_F(FieldWriterTest, WritesTetrahedra) {
  FieldMesh<3> mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.cells = {{0, 1, 2, 3}};
  auto writer = FieldWriter<3>::start(folder, "membrane", mesh, {});
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  writer.write(3, 0.5, std::vector<NodalField>{{"displacement", "cm", 3, values}});
  writer.sync();
  const auto times = grids("membrane");
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].get<std::string>("Topology.<xmlattr>.TopologyType"), "Tetrahedron");
  EXPECT_EQ(item(times[0].get_child("Topology")).extents, (std::vector<std::size_t>{1, 4}));
  EXPECT_EQ(item(times[0].get_child("Geometry")).values,
            (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(item(attribute(times[0], "displacement")).values, values);
}

TEST_F(FieldWriterTest, GoesOnAfterACheckpoint) {
  {
    auto writer = FieldWriter<2>::start(folder, "fluid", two_triangles(), {});
    for (const int step : {5, 10, 15, 20}) writer.write(step, 0.01 * step, fields_at(step));
    writer.sync();
  }
  const auto uninterrupted = read_text_file(folder / "fluid.xdmf");
  // The kill came in the middle of step 20; the checkpoint is from step 12.
  std::filesystem::resize_file(folder / "fluid_20.h5", 100);
  {
    auto writer = FieldWriter<2>::go_on(folder, "fluid", two_triangles(), {}, 12);
    EXPECT_EQ(grids("fluid").size(), 2u);
    EXPECT_FALSE(std::filesystem::exists(folder / "fluid_15.h5"));
    EXPECT_THROW(writer.write(10, 0.1, fields_at(10)), InputError);
    for (const int step : {15, 20}) writer.write(step, 0.01 * step, fields_at(step));
    writer.sync();
  }
  const auto times = grids("fluid");
  ASSERT_EQ(times.size(), 4u);
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(item(attribute(times[k], "pressure")).values, fields_at(5 * k + 5)[1].values);
  EXPECT_EQ(read_text_file(folder / "fluid.xdmf").size(), uninterrupted.size());
  EXPECT_EQ(files_with(".partial"), 0u);
}

// The index lags behind; what a killed process wrote is found all the same.
TEST_F(FieldWriterTest, GoesOnFromStepsThatTheIndexDoesNotName) {
  {
    auto writer = FieldWriter<2>::start(folder, "fluid", two_triangles(), {});
    for (const int step : {5, 10, 15}) writer.write(step, 0.01 * step, fields_at(step));
    EXPECT_LT(grids("fluid").size(), 3u);
  }
  auto writer = FieldWriter<2>::go_on(folder, "fluid", two_triangles(), {}, 15);
  EXPECT_EQ(grids("fluid").size(), 3u);
}

TEST_F(FieldWriterTest, StartingAnewRemovesTheOldSeriesOnly) {
  for (const std::string name : {"fluid", "fluid_wall"}) {
    auto writer = FieldWriter<2>::start(folder, name, two_triangles(), {});
    writer.write(1, 0.1, fields_at(1));
    writer.sync();
  }
  FieldWriter<2>::start(folder, "fluid", two_triangles(), {});
  EXPECT_FALSE(std::filesystem::exists(folder / "fluid_1.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fluid_mesh.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fluid_wall_1.h5"));
  EXPECT_TRUE(grids("fluid").empty());
  EXPECT_EQ(grids("fluid_wall").size(), 1u);
}

TEST_F(FieldWriterTest, RefusesWhatDoesNotFitTheMesh) {
  auto writer = FieldWriter<2>::start(folder, "fluid", two_triangles(), {});
  writer.write(1, 0.1, fields_at(1));
  writer.sync();
  using Fields = std::vector<NodalField>;
  EXPECT_THROW(writer.write(2, 0.2, Fields{{"p", "", 1, {1, 2, 3}}}), InputError);
  EXPECT_THROW(writer.write(2, 0.2, Fields{{"p", "", 3, std::vector<double>(12)}}), InputError);
  EXPECT_THROW(writer.write(2, 0.2, Fields{{"p q", "", 1, std::vector<double>(4)}}), InputError);
  EXPECT_THROW(writer.write(2, 0.2, Fields(2, {"p", "", 1, std::vector<double>(4)})), InputError);
  EXPECT_EQ(grids("fluid").size(), 1u);
  auto larger = two_triangles();
  larger.points.push_back({3, 3});
  EXPECT_THROW(FieldWriter<2>::go_on(folder, "fluid", larger, {}, 1), InputError);
  EXPECT_EQ(grids("fluid").size(), 1u);
  larger.cells.push_back({0, 1, 5});
  EXPECT_THROW(FieldWriter<2>::start(folder, "other", larger, {}), InputError);
}

} // namespace
} // namespace undula::fom
