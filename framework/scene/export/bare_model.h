// The scene file of a model that was loaded on its own, with what load() has assumed for it.
#pragma once

#include <string>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Text of a scene file that shows the same picture; `environment` is the image that LoadOptions named. A camera of the
// model that moves with its node is left to the model.
std::string bareModelFile(const Scene& scene, const std::string& environment);

}  // namespace fovea::scene
