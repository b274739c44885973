// Built-in scenes for programs whose main() is not ours.
#include "fovea/scenes.h"

static const bool kRegistered = [] {
  fovea::scenes::registerAll();
  return true;
}();
