// States as checkpoints.
#pragma once

#include "fom/output/checkpoint.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// All time levels of a state, as the arrays "x_0", "x_1" (velocity, pressure) and "d_0", "d_1"
/// (displacement); of a moving domain also "placement", "map_0", "map_1".
Checkpoint checkpoint_of(const State& state, const SceneStamp& scene,
                         const std::map<std::string, std::string>& provenance);

/// The state in a checkpoint. Throws InputError, naming `file`, if an array is missing or has not the size
/// that it has in `like`; where the state has a cut of its own, if the arrays differ in size.
State state_of(const Checkpoint& checkpoint, const State& like, const std::filesystem::path& file);

} // namespace undula::fom
