// The built-in scenes, as a library: the target fovea::scenes of the CMake package.
#pragma once

namespace fovea::scenes {

// Makes the built-in scenes known to scene::load() and scene::builtin(). Call it once before the first of these; further
// calls do nothing. The scenes register themselves when the library is loaded, and this call is the reason to load it.
void registerAll();

}  // namespace fovea::scenes
