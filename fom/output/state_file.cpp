#include "fom/output/state_file.hpp"

#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

constexpr std::array<const char*, 2> x_names = {"x_0", "x_1"}, d_names = {"d_0", "d_1"},
                                     map_names = {"map_0", "map_1"};
constexpr const char* placement_name = "placement";

std::vector<double> to_array(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

} // namespace

Checkpoint checkpoint_of(const State& state, const SceneStamp& scene,
                         const std::map<std::string, std::string>& provenance) {
  Checkpoint checkpoint{state.step, state.time, {{"last_step", state.last_step}}, {}, scene, provenance};
  if (state.placement.size() > 0) checkpoint.arrays[placement_name] = to_array(state.placement);
  for (std::size_t level = 0; level < 2; ++level) {
    checkpoint.arrays[x_names[level]] = to_array(state.x[level]);
    checkpoint.arrays[d_names[level]] = to_array(state.d[level]);
    if (state.map[level].size() > 0) checkpoint.arrays[map_names[level]] = to_array(state.map[level]);
  }
  return checkpoint;
}

State state_of(const Checkpoint& checkpoint, const State& like, const std::filesystem::path& file) {
  const auto refuse = [&](const char* name, std::size_t size, const std::string& allowed) {
    throw InputError("the checkpoint does not fit the mesh",
                     "array " + std::string(name) + " of " + std::to_string(size) + " values", allowed,
                     file.string());
  };
  const auto array = [&](const char* name) -> Eigen::VectorXd {
    const auto found = checkpoint.arrays.find(name);
    if (found == checkpoint.arrays.end()) return {};
    return Eigen::Map<const Eigen::VectorXd>(found->second.data(),
                                             static_cast<Eigen::Index>(found->second.size()));
  };
  State state;
  state.step = checkpoint.step;
  state.time = checkpoint.time;
  if (const auto found = checkpoint.scalars.find("last_step"); found != checkpoint.scalars.end())
    state.last_step = found->second;
  state.placement = array(placement_name);
  for (std::size_t level = 0; level < 2; ++level) {
    state.x[level] = array(x_names[level]);
    state.d[level] = array(d_names[level]);
    state.map[level] = array(map_names[level]);
    // A cut of its own has unknowns of its own.
    const bool own_cut = state.placement.size() > 0 && state.map[0].size() == 0;
    const auto check = [&](const char* name, const Eigen::VectorXd& values, Eigen::Index at_rest) {
      const Eigen::Index expected = own_cut ? state.x[0].size() : at_rest;
      if (values.size() != expected || values.size() == 0)
        refuse(name, static_cast<std::size_t>(values.size()), std::to_string(expected) + " values");
    };
    check(x_names[level], state.x[level], like.x[level].size());
    check(d_names[level], state.d[level], like.d[level].size());
  }
  return state;
}

} // namespace undula::fom
