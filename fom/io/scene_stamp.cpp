#include "fom/io/scene_stamp.hpp"

#include "fom/scene/scene_file.hpp"

namespace undula {

SceneStamp stamp_scene(const Scene& scene) { return {scene_hash(scene), scene_to_toml(scene)}; }

} // namespace undula
