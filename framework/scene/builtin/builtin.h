// Generators of the built-in scenes; private to framework/scene. A generator makes what is there: geometry,
// materials, what deforms and how, the main light, the still view, exposure and background. What happens in it
// (camera path, gaze, movers, the moving light) is in samples/scenes/NAME.json, whose first frame is that still
// view. A new scene is a generator here and in load.cpp, that file, and a line in
// tests/unit/builtin_scenes_test.cpp. model.h, textures.h and plants.h are the tools.
#pragma once

#include "framework/scene/scene.h"

namespace fovea::scene {

Scene cornellBox();
Scene cornellBoxMoving();
Scene atriumScene();
Scene balconyScene();
Scene roomScene();
Scene yardScene();

}  // namespace fovea::scene
