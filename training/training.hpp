// From a scene to a reduced model, and from measured curves to a scene.
//
//   sampling/     where in the box of operating points the full order is run
//   campaign/     those runs, and their records on disk
//   reduction/    bases, projection, judgement
//   study/        runs over any keys of a scene, and what the keys do
//   emulation/    Gaussian processes of what the runs come to
//   calibration/  fits of a scene's keys, and what its tolerances mean for the curve
#pragma once

namespace undula::geometry {}
namespace undula::fom {}

namespace undula::training {
using namespace geometry;
using namespace fom;
} // namespace undula::training
