// Generators of the built-in scenes; private to framework/scene.
#pragma once

#include "framework/scene/scene.h"

namespace fovea::scene {

Scene cornellBox();
Scene atriumScene();

}  // namespace fovea::scene
