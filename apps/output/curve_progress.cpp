#include "apps/output/curve_progress.hpp"

#include <optional>

#include "apps/output/progress.hpp"

namespace undula::apps {

std::vector<CurvePoint> curve_with_progress(const std::string& label, Level& level, const Scene& scene,
                                            std::span<const double> heads_mmHg, MPI_Comm comm) {
  int rank = 0;
  if (comm != MPI_COMM_NULL) {
    MPI_Comm_rank(comm, &rank);
  }
  std::optional<Progress> progress;
  if (rank == 0) {
    progress.emplace(label, static_cast<long>(heads_mmHg.size()));
  }
  long done = 0;
  return level.curve(scene, heads_mmHg, [&] {
    ++done;
    if (progress) {
      progress->update(done);
    }
  });
}

} // namespace undula::apps
