// The bands of the curves of `undula hq`: by the tolerances of the scene, narrowed by measured curves, by
// draws.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <vector>

#include "apps/output/curve_band.hpp"

namespace undula::apps {

/// The bands of curves that differ by their voltage. `given` may be empty; computed flows and their band are
/// set in it. Curves of thin gaps need one rank each, so that every rank computes its own; those of finite
/// elements take all ranks one after the other. Collective over `comm`.
std::vector<CurveBand> bands_of_curves(std::span<const Scene> scenes,
                                       std::span<const std::vector<CurvePoint>> curves, GivenFlows& given,
                                       MPI_Comm comm);

/// Curves at random inputs that the data allow: replaces the linear law in `bands`, and returns a sentence on
/// them. Throws NumericsError where fewer than two draws come to an end. Collective over `comm`.
std::string draw_curves(std::span<const Scene> scenes, std::span<const std::vector<CurvePoint>> curves,
                        const GivenFlows& given, int count, MPI_Comm comm, std::span<CurveBand> bands);

} // namespace undula::apps
