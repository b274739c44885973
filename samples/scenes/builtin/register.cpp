#include "fovea/scenes.h"

namespace fovea::scenes {

// FOVEA_SCENE has registered them when the library was loaded.
void registerAll() {}

}  // namespace fovea::scenes
