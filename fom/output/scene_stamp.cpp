#include "fom/output/scene_stamp.hpp"

#include "fom/scene/scene_file.hpp"

namespace undula::fom {

SceneStamp stamp_scene(const Scene& scene) { return {scene_hash(scene), scene_to_toml(scene)}; }

} // namespace undula::fom
