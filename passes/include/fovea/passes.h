// The stock passes, as a library: the target fovea::passes of the CMake package.
#pragma once

namespace fovea::passes {

// Makes the stock passes known to graphs. Call it once before the first graph is loaded; further calls do nothing. The
// passes register themselves when the library is loaded, and this call is the reason to load it. Throws Error(Internal)
// if a pass that is linked into the process contradicts itself, with every such pass.
void registerAll();

}  // namespace fovea::passes
