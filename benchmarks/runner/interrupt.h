// Ctrl-C: the first one asks to finish the frame under way, the second one ends the process.
#pragma once

namespace fovea::bench {

void catchInterrupts();
bool interrupted();

}  // namespace fovea::bench
