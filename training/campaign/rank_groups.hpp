// Runs shared out over groups of ranks.
#pragma once

#include <mpi.h>

#include <optional>
#include <utility>

#include "training/training.hpp"

namespace undula::training {

/// A part of the ranks; also freed where a run ends with an exception.
class RankGroup {
public:
  /// Groups of `ranks_per_run` neighbours. Collective over `world`.
  RankGroup(MPI_Comm world, int ranks_per_run) {
    int rank = 0;
    MPI_Comm_rank(world, &rank);
    MPI_Comm_split(world, rank / ranks_per_run, rank, &comm_);
  }
  RankGroup(const RankGroup&) = delete;
  RankGroup& operator=(const RankGroup&) = delete;
  ~RankGroup() { MPI_Comm_free(&comm_); }
  operator MPI_Comm() const { return comm_; }
  [[nodiscard]] bool is_root() const {
    int rank = 0;
    MPI_Comm_rank(comm_, &rank);
    return rank == 0;
  }

private:
  MPI_Comm comm_ = MPI_COMM_NULL;
};

/// Computes until nothing is left: `next`, asked on the group's root, gives a claim and the number of what it
/// claims, or nothing; `compute(number, claim)` runs on every rank of the group, with a null claim but on its
/// root. Collective over the group.
template <typename Claim, typename Next, typename Compute>
void work_off(const RankGroup& group, const Next& next, const Compute& compute) {
  for (;;) {
    using Claimed = std::optional<std::pair<Claim, int>>;
    const Claimed claimed = group.is_root() ? Claimed(next()) : Claimed();
    int number = claimed ? claimed->second : -1;
    MPI_Bcast(&number, 1, MPI_INT, 0, group);
    if (number < 0) return;
    compute(number, claimed ? &claimed->first : nullptr);
  }
}

} // namespace undula::training
