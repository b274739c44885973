// The pieces that the balcony is put together from; private to balcony*.cpp. Metres; each stands on y = 0
// about the origin unless it says otherwise.
#pragma once

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::balcony {

// Materials of the scene, as SceneBuilder::material gave them.
struct Palette {
  uint32_t limewash, ochre, rose, stone, tile, tileBlue, mortar, street, roofTiles, blue, green, brown, white,
      cream, dark, iron, brass, clay, glaze, soil, bark, leaf, darkLeaf, paleLeaf, bract, bloom, lemon,
      awning, cushion, stripedCushion, linen, shirt, towel, paper, lampPane, curtain;
};
Palette makePalette(model::SceneBuilder& builder);

// ---- Joinery and masonry: against the wall z = 0, looking along +z ----

// A leaf from (0, 0) to (width, height), 4 cm thick, with slats. `fine`: near the viewer.
model::MeshBuilder shutterLeaf(uint32_t wood, float width, float height, bool fine);
enum class Shutters { Closed, Open, Ajar };
// In a recess of a wall: casements with curtains behind, and the shutters before it. The opening's lower
// edge's middle is the origin; `door`: no sill, and wooden panels below the panes.
model::MeshBuilder window(const Palette& palette, uint32_t wood, float width, float height, Shutters shutters,
                          bool door, bool fine);
// A small iron balcony: floor on y = 0, half of it to each side.
model::MeshBuilder ironBalcony(const Palette& palette, float width, float depth);
model::Shape baluster(float height, int segments);
model::Shape eaves(float length);  // tiles along x, from the wall to 0.5 m before it; top of the wall y = 0

// ---- Furniture ----

model::MeshBuilder bistroChair(const Palette& palette);
model::MeshBuilder bistroTable(const Palette& palette);  // top at 0.74
model::MeshBuilder tableware(const Palette& palette);    // stands on y = 0, about 0.3 m around the origin
model::MeshBuilder lantern(const Palette& palette);      // hangs from the origin
SubdivisionCage pillow(float width, float depth, float height, bool tufted);

// Pots of different shapes; soil at about 0.9 of the height.
enum class PotShape { Rim, Belly, Square, Trough };
model::MeshBuilder pot(uint32_t clay, uint32_t soil, PotShape shape, float radius, float height);

// ---- Cloth ----

// The awning: a valance with scallops, a slack roof of `depth`, and a blind that falls to `drop` below it.
// u along +x from 0 to width; the roof starts at z = 0 and runs to -depth, the blind hangs there.
struct AwningForm {
  float width = 2.8f, depth = 1.5f, drop = 2.3f, valance = 0.22f;
  float slope = -0.16f;                      // of the roof, over its width
  float billow = 0.1f, wave = 0, phase = 0;  // of the blind and the valance, m
  float lift = 0;                            // of the roof, m
};
model::Sheet awning(const AwningForm& form);

// Washing that hangs from y = 0 along x.
model::Shape hungCloth(float width, float height, uint32_t seed);
model::Shape hungShirt(float size, uint32_t seed);

}  // namespace fovea::scene::balcony
