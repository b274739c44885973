// Handles Ctrl-C: the first one asks the program to finish the current frame, the second one ends the process.
#pragma once

namespace fovea::bench {

void catchInterrupts();
bool interrupted();

}  // namespace fovea::bench
