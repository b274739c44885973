// The pieces of which the atrium is built. Private to atrium*.cpp. Lengths are in metres; each piece stands on y = 0
// about the origin unless stated otherwise.
#pragma once

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::atrium {

// Materials of the scene, as returned by SceneBuilder::material.
struct Palette {
  uint32_t limestone, ashlar, plaster, dado, tiles, roofTiles, floorPale, floorWarm, floorDark, mortar, wood,
      door, iron, clay, glaze, white, soil, bark, leaf, darkLeaf, orange, paper;
  uint32_t cloth[4];   // madder red, indigo, ochre, green
  uint32_t carpet[2];  // striped
};
Palette makePalette(model::SceneBuilder& builder);

// A column with an attic base, a swelling shaft, and a capital of leaves and scrolls. `height` includes the abacus.
model::MeshBuilder column(uint32_t stone, float height);
model::MeshBuilder colonnette(uint32_t stone, float height);
model::Shape baluster(float height);
model::Shape groinVault(float side, float rise);  // springing at y = 0, seen from below
model::MeshBuilder tondo(uint32_t rim, uint32_t glaze, uint32_t relief);  // looks along +z
model::MeshBuilder archDoor(uint32_t wood, uint32_t iron, float width, float spring);
model::MeshBuilder shutters(uint32_t wood, float width, float height);
model::MeshBuilder wellHead(const Palette& palette);
model::MeshBuilder pot(uint32_t clay, uint32_t soil, float radius, float height);
model::MeshBuilder orangeTree(const Palette& palette, uint32_t seed);
model::MeshBuilder lantern(const Palette& palette);
model::MeshBuilder bench(uint32_t stone, float width);
model::MeshBuilder jar(uint32_t clay, float height);
model::Shape paperPlane();  // flies along -z, wing span 1

// A curtain on a rod from (-width/2, 0) to (width/2, 0), falling to -height. `drawn` is from -1 to 1: tied back to
// the left or right; at 0 it hangs free. `billow`, `wave` (m) and `phase` describe the effect of the wind.
struct DrapeForm {
  float width = 2.4f, height = 2.8f, drawn = 0, billow = 0, wave = 0, phase = 0, folds = 7;
  uint32_t seed = 1;
};
model::Sheet drape(const DrapeForm& form, uint32_t columns, uint32_t rows);

}  // namespace fovea::scene::atrium
