// A small car for scenes with a garage or a street. Lengths are in metres.
#pragma once

#include <cstdint>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {

struct CarLook {
  uint32_t paint, glass, rubber, rim, chrome, dark, lens, tail, plate;
};
// A hatchback of 3.5 m x 1.55 m x 1.4 m, which stands on y = 0 about the origin and looks along +z.
MeshBuilder hatchback(const CarLook& look);

// A tyre about the origin whose axis is y, 0.16 m wide, with an outer radius of 0.295 m.
Shape tyre();

}  // namespace fovea::scene::model
