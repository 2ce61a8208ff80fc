#include "fom/levels/level.hpp"

#include "fom/levels/finite_element_level.hpp"
#include "fom/levels/long_wave_level.hpp"
#include "fom/levels/marched_curve.hpp"
#include "fom/levels/thin_gap_level.hpp"

namespace undula::fom {

std::vector<CurvePoint> MarchingLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                             const std::function<void()>& on_point) {
  return marched_curve(*this, scene, heads_mmHg, on_point);
}

std::unique_ptr<MarchingLevel> prepare_level(const Scene& scene, MPI_Comm comm, PhaseTimer& timer) {
  if (scene.space == Space::thin_gap) return std::make_unique<ThinGapLevel>(scene, timer);
  if (scene.space == Space::long_wave) return std::make_unique<LongWaveLevel>(scene, timer);
  return std::make_unique<FiniteElementLevel>(scene, comm, timer);
}

} // namespace undula::fom
