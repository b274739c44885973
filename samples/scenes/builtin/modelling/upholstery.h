// Cushions and padding of the built-in and the validation scenes.
#pragma once

#include <cstdint>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {

// A pillow about the origin in the x-y plane, refined from a cage.
Shape cushion(float width, float height, float thickness, uint32_t seed, uint32_t level = 2);

// A round cushion about the origin whose axis is y, with a button in the middle of each side and a piped rim.
Shape roundCushion(float radius, float height, int segments = 48);

// A padded block that stands on y = 0, centred in x and z. Its top has buttons in a diamond pattern, `columns` along x
// and `rows` along z, with grooves between them.
Shape buttonedPad(glm::vec3 size, int columns, int rows);

// The same with straight grooves along z, which divide the width into `channels`.
Shape channelPad(glm::vec3 size, int channels);

}  // namespace fovea::scene::model
