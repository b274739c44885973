// The pieces of which the balcony is built. Private to balcony*.cpp. Lengths are in metres; each piece stands on y =
// 0 about the origin unless stated otherwise.
#pragma once

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::balcony {

// Materials of the scene, as returned by SceneBuilder::material.
struct Palette {
  uint32_t limewash, ochre, rose, stone, tile, tileBlue, mortar, street, roofTiles, blue, green, brown, white,
      cream, dark, iron, brass, clay, glaze, soil, bark, leaf, darkLeaf, paleLeaf, bract, bloom, lemon,
      awning, cushion, stripedCushion, linen, shirt, towel, paper, lampPane, curtain;
};
Palette makePalette(model::SceneBuilder& builder);

// ---- Joinery and masonry: against the wall z = 0, looking along +z ----

// A leaf from (0, 0) to (width, height), 4 cm thick, with slats. `fine` is for leaves near the viewer.
model::MeshBuilder shutterLeaf(uint32_t wood, float width, float height, bool fine);
enum class Shutters { Closed, Open, Ajar };
// A window in a recess of a wall: casements with curtains behind them and shutters in front. The origin is the middle
// of the opening's lower edge. `door` replaces the sill and adds wooden panels below the panes.
model::MeshBuilder window(const Palette& palette, uint32_t wood, float width, float height, Shutters shutters,
                          bool door, bool fine);
// A small iron balcony with its floor on y = 0, half of it to each side.
model::MeshBuilder ironBalcony(const Palette& palette, float width, float depth);
model::Shape baluster(float height, int segments);
model::Shape eaves(float length);  // tiles along x, from the wall to 0.5 m before it; top of the wall y = 0

// ---- Furniture ----

model::MeshBuilder bistroChair(const Palette& palette);
model::MeshBuilder bistroTable(const Palette& palette);  // top at 0.74
model::MeshBuilder tableware(const Palette& palette);    // stands on y = 0, about 0.3 m around the origin
model::MeshBuilder lantern(const Palette& palette);      // hangs from the origin
SubdivisionCage pillow(float width, float depth, float height, bool tufted);

// Pots of different shapes, filled with soil to about 0.9 of their height.
enum class PotShape { Rim, Belly, Square, Trough };
model::MeshBuilder pot(uint32_t clay, uint32_t soil, PotShape shape, float radius, float height);

// ---- Cloth ----

// The awning: a valance with scallops, a slack roof of `depth`, and a blind that falls to `drop` below it. u runs
// along +x from 0 to width; the roof starts at z = 0 and ends at -depth, where the blind hangs.
struct AwningForm {
  float width = 2.8f, depth = 1.5f, drop = 2.3f, valance = 0.22f;
  float slope = -0.16f;                      // rise of the roof over its width, m
  float billow = 0.1f, wave = 0, phase = 0;  // of the blind and the valance, m
  float lift = 0;                            // of the roof, m
};
model::Sheet awning(const AwningForm& form);

// Washing that hangs from y = 0 along x.
model::Shape hungCloth(float width, float height, uint32_t seed);
model::Shape hungShirt(float size, uint32_t seed);

}  // namespace fovea::scene::balcony
