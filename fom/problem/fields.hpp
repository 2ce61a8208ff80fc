// Functions of place and time that a problem is stated with.
#pragma once

#include <functional>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// Vector and scalar field of position (cm) and time (s).
template <int dim>
using VectorField = std::function<Point<dim>(const Point<dim>&, double)>;
template <int dim>
using ScalarField = std::function<double(const Point<dim>&, double)>;
using TimeFunction = std::function<double(double)>;

} // namespace undula::fom
