// What `undula check` finds: everything that a run would do before its first step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/scene/scene.hpp"
#include "fom/thin_gap/thin_gap.hpp"
#include "geometry/hose/roller_track.hpp"
#include "geometry/mesh/box_grid.hpp"
#include "geometry/mesh/mesh_quality.hpp"

namespace undula::apps {

struct CheckedMesh {
  std::string name; ///< "background", or of the solid
  std::string file; ///< of an imported mesh
  MeshQuality quality;
  Box<2> box;         ///< cm, around it
  int reoriented = 0; ///< cells of the file that were turned round
};

/// A weight of the stabilisation and where it comes from.
struct CheckedWeight {
  std::string key;    ///< of section [stabilisation], without the section
  std::string value;  ///< in force, in the unit of the key
  std::string origin; ///< "stated", "derived", "published" or "order 2"
};

struct SceneCheck {
  double estimated_cells = 0;            ///< of all meshes, before they were made
  std::vector<CheckedMesh> meshes;       ///< none for thin gaps
  std::optional<ThinGapLayout> thin_gap; ///< of thin gaps
  std::optional<RollerTrack> hose;       ///< of peristaltic pumps
  std::vector<CheckedWeight> weights;    ///< of the stabilisation; none for thin gaps
  int unknowns = 0;                      ///< of one step
  int steps = 0;                         ///< of a run
  std::vector<std::string> walls;        ///< boundaries without a condition of their own
  std::vector<std::string> notes;        ///< what is allowed, and better known
};

/// Meshes and cuts the scene at rest, and plans what it observes. Throws InputError for what is wrong.
SceneCheck check_scene(const Scene& scene);

} // namespace undula::apps
