// What draws the fields of a reduced model: meshes at rest, and the modes on their points. A part of the
// model's file that training writes where it is asked to, and that no curve needs.
#pragma once

#include <string>

#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// Triangles; points are repeated where a field jumps.
struct DrawnMesh {
  Eigen::MatrixXd points; ///< n x 2: (r, z), cm
  Eigen::MatrixXi cells;  ///< m x 3: numbers of points
};

/// Rows of modes with two components: those of point 0, of point 1, ...
struct FieldBases {
  DrawnMesh fluid, solids;
  Eigen::MatrixXd velocity;     ///< 2 n x nu: velocity = velocity a_u, cm/s
  Eigen::MatrixXd pressure;     ///< n x np: pressure = pressure a_p, dyn/cm^2
  Eigen::MatrixXd displacement; ///< 2 k x nv
  Eigen::VectorXd holder;       ///< 2 k: displacement = displacement a_d + holder D, cm
};

inline constexpr int field_bases_version = 1;

/// save_model with the group "fields" (attribute format_version): fluid/points, fluid/cells, fluid/velocity
/// (n x 2 x nu), fluid/pressure (n x np), solids/points, solids/cells, solids/displacement (k x 2 x nv),
/// solids/holder (k x 2). Programs that know no fields read the model as any other. Throws InputError for
/// bases that do not fit the model.
void save_model(const Model& model, const std::string& file, const FieldBases& fields);

} // namespace undula::rom
