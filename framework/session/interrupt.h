// Handles Ctrl-C and SIGTERM.
#pragma once

namespace fovea::session {

// From now on, an interrupt ends the process with exit code 130: for stages that leave nothing half done.
void stopAtInterrupts();
// From now on, the first interrupt asks the program to finish the current frame, and the second one ends the process.
void catchInterrupts();
bool interrupted();

}  // namespace fovea::session
