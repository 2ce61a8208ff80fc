#include "fom/output/visual_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fom/output/solid_stress.hpp"
#include "fom/space/velocity_element.hpp"

namespace undula::fom {

namespace {

/// Simplices that a quadratic one is split into, by its nodes: vertices, then mid-points in the order of
/// local_edges. In space the octahedron that four corners leave is split along one of its diagonals.
template <int dim>
constexpr auto split_simplices() {
  if constexpr (dim == 2)
    return std::array<std::array<int, 3>, 4>{{{0, 3, 4}, {3, 1, 5}, {4, 5, 2}, {3, 5, 4}}};
  else
    return std::array<std::array<int, 4>, 8>{{{0, 4, 5, 6},
                                              {4, 1, 7, 8},
                                              {5, 7, 2, 9},
                                              {6, 8, 9, 3},
                                              {4, 9, 7, 5},
                                              {4, 9, 8, 7},
                                              {4, 9, 6, 8},
                                              {4, 9, 5, 6}}};
}

/// From the first vertex to the others, column by column.
template <int dim>
Eigen::Matrix<double, dim, dim> edges_of(const std::array<Point<dim>, dim + 1>& vertices) {
  Eigen::Matrix<double, dim, dim> edges;
  for (int a = 1; a <= dim; ++a) edges.col(a - 1) = vertices[a] - vertices[0];
  return edges;
}

} // namespace

template <int dim>
bool is_flat(const std::array<Point<dim>, dim + 1>& vertices) {
  // A filter that divides by the measure (a gradient) loses all digits below this part of a regular simplex.
  constexpr double least = 1e-9;
  double longest = 0;
  for (int a = 0; a <= dim; ++a)
    for (int b = 0; b < a; ++b) longest = std::max(longest, (vertices[a] - vertices[b]).norm());
  return std::abs(edges_of<dim>(vertices).determinant()) <= least * std::pow(longest, dim);
}

template <int dim>
FluidPicture<dim> fluid_picture(const Discretisation<dim>& disc) {
  using Barycentric = Eigen::Matrix<double, dim + 1, 1>;
  FluidPicture<dim> picture;
  const auto& cut = disc.cut;
  std::vector<int> point_of_node(static_cast<std::size_t>(disc.velocity_nodes()), -1);
  const auto add_point = [&](const Point<dim>& x, int part, const Barycentric& lambda) {
    picture.mesh.points.push_back(x);
    picture.part.push_back(part);
    picture.lambda.push_back(lambda);
    return static_cast<int>(picture.mesh.points.size()) - 1;
  };
  const auto point_at = [&](int node, int part, const Barycentric& lambda) {
    int& point = point_of_node[static_cast<std::size_t>(node)];
    if (point < 0) point = add_point(disc.velocity_position(node), part, lambda);
    return point;
  };
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& part = cut.parts[p];
    const int index = static_cast<int>(p);
    std::array<int, dim + 1> simplex;
    if (!part.cut) {
      const auto& vertices = disc.fluid_nodes.part_dofs[p];
      for (int a = 0; a <= dim; ++a) simplex[a] = point_at(vertices[a], index, Barycentric::Unit(a));
      if (disc.problem.velocity_order == 1) {
        picture.mesh.cells.push_back(simplex);
        continue;
      }
      constexpr auto edges = local_edges<dim>();
      std::array<int, QuadraticSpace<dim>::nodes_per_cell> nodes{};
      std::copy(simplex.begin(), simplex.end(), nodes.begin());
      for (std::size_t e = 0; e < edges.size(); ++e)
        nodes[dim + 1 + e] =
            point_at(disc.vertex_nodes() + disc.fluid_edges.part_edges[p][e], index,
                     0.5 * (Barycentric::Unit(edges[e][0]) + Barycentric::Unit(edges[e][1])));
      for (const auto& small : split_simplices<dim>()) {
        for (int a = 0; a <= dim; ++a) simplex[a] = nodes[static_cast<std::size_t>(small[a])];
        picture.mesh.cells.push_back(simplex);
      }
      continue;
    }
    for (int s = part.simplex_begin; s < part.simplex_end; ++s) {
      const auto& vertices = cut.simplices[s];
      if (is_flat<dim>(vertices)) continue;
      for (int a = 0; a <= dim; ++a)
        simplex[a] = add_point(vertices[a], index, barycentric_coordinates(cut.mesh, part.cell, vertices[a]));
      if (edges_of<dim>(vertices).determinant() < 0) std::swap(simplex[dim - 1], simplex[dim]);
      picture.mesh.cells.push_back(simplex);
    }
  }
  return picture;
}

template <int dim>
FluidPicture<dim> moved_picture(const Discretisation<dim>& disc) {
  auto picture = fluid_picture(disc);
  if (disc.map.is_identity()) return picture;
  for (std::size_t p = 0; p < picture.part.size(); ++p)
    for (int k = 0; k <= dim; ++k)
      picture.mesh.points[p] +=
          picture.lambda[p][k] *
          disc.map.displacement[disc.fluid_nodes.part_dofs[static_cast<std::size_t>(picture.part[p])][k]];
  return picture;
}

template <int dim>
FieldMesh<dim> solid_picture(const Discretisation<dim>& disc) {
  FieldMesh<dim> mesh;
  for (const auto& space : disc.solid_spaces) {
    const int first = static_cast<int>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), space.nodes.begin(), space.nodes.end());
    for (const auto& cell : space.cell_nodes)
      for (const auto& small : split_simplices<dim>()) {
        auto& simplex = mesh.cells.emplace_back();
        for (int a = 0; a <= dim; ++a) simplex[a] = first + cell[static_cast<std::size_t>(small[a])];
      }
  }
  return mesh;
}

template <int dim>
std::vector<NodalField> fluid_fields(const Discretisation<dim>& disc, const FluidPicture<dim>& picture,
                                     const State& state) {
  NodalField velocity{"velocity", "cm/s", dim, {}};
  NodalField pressure{"pressure", "dyn/cm^2", 1, {}};
  const auto& x = state.x[0];
  for (std::size_t p = 0; p < picture.part.size(); ++p) {
    const int part = picture.part[p];
    const auto& lambda = picture.lambda[p];
    const Point<dim> value = with_order(disc, [&](auto order) -> Point<dim> {
      using Element = VelocityElement<dim, order>;
      return Element::coefficients(disc, part, x) * Element::values(lambda);
    });
    velocity.values.insert(velocity.values.end(), value.data(), value.data() + dim);
    pressure.values.push_back(sample_pressure<dim>(disc, part, lambda, x));
  }
  return {std::move(velocity), std::move(pressure)};
}

template <int dim>
std::vector<NodalField> solid_fields(const Discretisation<dim>& disc, const State& state) {
  const auto solid_part = [&](const Eigen::VectorXd& all) {
    return std::vector<double>(all.data() + disc.fluid_unknowns(), all.data() + disc.unknowns());
  };
  return {{"displacement", "cm", dim, solid_part(state.d[0])},
          {"velocity", "cm/s", dim, solid_part(state.x[0])},
          {"von_mises", "dyn/cm^2", 1, von_mises_stress<dim>(disc, state.d[0])}};
}

template bool is_flat<2>(const std::array<Point<2>, 3>&);
template FluidPicture<2> fluid_picture(const Discretisation<2>&);
template FluidPicture<2> moved_picture(const Discretisation<2>&);
template FieldMesh<2> solid_picture(const Discretisation<2>&);
template std::vector<NodalField> fluid_fields(const Discretisation<2>&, const FluidPicture<2>&, const State&);
template std::vector<NodalField> solid_fields(const Discretisation<2>&, const State&);

template bool is_flat<3>(const std::array<Point<3>, 4>&);
template FluidPicture<3> fluid_picture(const Discretisation<3>&);
template FluidPicture<3> moved_picture(const Discretisation<3>&);
template FieldMesh<3> solid_picture(const Discretisation<3>&);
template std::vector<NodalField> fluid_fields(const Discretisation<3>&, const FluidPicture<3>&, const State&);
template std::vector<NodalField> solid_fields(const Discretisation<3>&, const State&);

} // namespace undula::fom
