// Writes the scene file beside an exported model, with everything that glTF cannot express.
// Private to framework/scene.
#pragma once

#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

struct SceneFileNames {
  std::string model, environment;               // files, relative to the scene file; "" without a map
  std::vector<std::string> nodes;               // names in the model, all different
  std::vector<std::string> lights, animations;  // likewise; "" for an animation that is not in the model
};

// Text of a scene file (samples/scenes/README.md) that shows `scene` through the exported model.
std::string sceneFileText(const Scene& scene, const SceneFileNames& names, Diagnostics& warnings);

}  // namespace fovea::scene
