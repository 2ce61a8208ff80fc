#include "fom/state_file.hpp"

#include "base/error.hpp"

namespace undula {
namespace {

constexpr std::array<const char*, 2> x_names = {"x_0", "x_1"}, d_names = {"d_0", "d_1"};

std::vector<double> to_array(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

} // namespace

Checkpoint checkpoint_of(const State& state, const SceneStamp& scene,
                         const std::map<std::string, std::string>& provenance) {
  Checkpoint checkpoint{state.step, state.time, {}, {}, scene, provenance};
  for (std::size_t level = 0; level < 2; ++level) {
    checkpoint.arrays[x_names[level]] = to_array(state.x[level]);
    checkpoint.arrays[d_names[level]] = to_array(state.d[level]);
  }
  return checkpoint;
}

State state_of(const Checkpoint& checkpoint, const State& like, const std::filesystem::path& file) {
  const auto array = [&](const char* name, Eigen::Index expected) -> Eigen::VectorXd {
    const auto found = checkpoint.arrays.find(name);
    const auto size = found == checkpoint.arrays.end() ? 0 : found->second.size();
    if (found == checkpoint.arrays.end() || size != static_cast<std::size_t>(expected))
      throw InputError("the checkpoint does not fit the mesh",
                       "array " + std::string(name) + " of " + std::to_string(size) + " values",
                       std::to_string(expected) + " values", file.string());
    return Eigen::Map<const Eigen::VectorXd>(found->second.data(), expected);
  };
  State state;
  state.step = checkpoint.step;
  state.time = checkpoint.time;
  for (std::size_t level = 0; level < 2; ++level) {
    state.x[level] = array(x_names[level], like.x[level].size());
    state.d[level] = array(d_names[level], like.d[level].size());
  }
  return state;
}

} // namespace undula
