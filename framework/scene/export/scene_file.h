// The scene file beside an exported model: what glTF has no place for. Private to framework/scene.
#pragma once

#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

struct SceneFileNames {
  std::string model;                            // relative to the scene file
  std::vector<std::string> nodes;               // as the model calls them; no name twice
  std::vector<std::string> lights, animations;  // likewise; an animation that is not there: ""
};

// The text of a scene file (samples/scenes/README.md) that shows `scene` by the exported model.
std::string sceneFileText(const Scene& scene, const SceneFileNames& names, Diagnostics& warnings);

}  // namespace fovea::scene
