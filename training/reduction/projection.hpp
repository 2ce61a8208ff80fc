// Galerkin projection of the full-order operators onto the reduced bases.
#pragma once

#include "rom/fixed_domain/model.hpp"
#include "training/reduction/bases.hpp"

namespace undula::training {

/// See rom::Operators for the system. Exact: the stabilisation is projected as it is, convection becomes a
/// tensor. Runs with one rank. Throws InputError for openings whose condition is not polynomial
/// (static_pressure).
rom::Operators project(const PreparedScene& prepared, const Bases& bases);

} // namespace undula::training
