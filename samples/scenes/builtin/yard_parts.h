// The pieces of which the yard is built. Private to yard*.cpp. Lengths are in metres; each piece stands on y = 0
// about the origin and looks along +z unless stated otherwise.
#pragma once

#include <vector>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::yard {

// Materials of the scene, as returned by SceneBuilder::material. `..Across` means that the grain runs along x.
struct Palette {
  uint32_t pale, ochre, white, brick, plinth, stone, roof, zinc, pane, inside, frame, door, shutter,
      paving[3], mortar, lawn, blade[2], sand, soil, orange, reflex, timber, timberAcross, fence, shed, felt,
      blue, green, steel, rubber, rope, teal, leather, tray, leaf[3], bark, birch, flag, mast, red, yellow,
      cream, clay, clover, fallen;
};
Palette makePalette(model::SceneBuilder& builder);

// A path that runs straight from corner to corner and is rounded over `reach` metres on both sides of each,
// for bent pipes.
std::vector<glm::vec3> roundedPath(const std::vector<glm::vec3>& corners, float reach, int steps = 7);

// A straight round bar from a to b.
model::Shape pole(glm::vec3 a, glm::vec3 b, float radius, int sides = 16);

// ---- Buildings -------------------------------------------------------------------------------------------

struct Window {
  float x = 0, sill = 1;  // lower middle of the opening
  bool shutters = false;
};
inline constexpr glm::vec2 kWindowSize{1.0f, 1.4f};
// A house front from -width/2 to width/2, with its face on z = 0 and the house behind it: plaster on a plinth,
// windows, doors (0.98 m wide, at the x coordinates `doors`) and a cornice.
struct Front {
  float width = 10, height = 6.4f;
  uint32_t plaster = 0;
  std::vector<Window> windows;
  std::vector<float> doors;
};
model::MeshBuilder front(const Palette& p, const Front& f);
// Eaves with boards, a gutter and the first rows of tiles along x, on a wall whose top is at y = 0.
model::MeshBuilder eaves(const Palette& p, float width, int rows);
// The low white store in front of the back house: `width` wide and `depth` deep, up to the wall behind it.
model::MeshBuilder store(const Palette& p, float width, float depth, float height);
model::MeshBuilder shed(const Palette& p);
model::MeshBuilder fence(const Palette& p, float length, float height);  // along x
model::MeshBuilder downpipe(const Palette& p, float height);

// ---- Playground ------------------------------------------------------------------------------------------

inline constexpr float kSwingBar = 2.15f;         // height of the pivots
model::MeshBuilder slideTower(const Palette& p);  // the slide runs down along +z
model::MeshBuilder swingFrame(const Palette& p);  // the bar along x
model::MeshBuilder swingSeat(const Palette& p);   // hangs from the origin, moves in y-z
model::MeshBuilder climbingDome(const Palette& p, float radius);
model::MeshBuilder sandbox(const Palette& p, float edge);

// ---- Works and things ------------------------------------------------------------------------------------

model::MeshBuilder barrier(const Palette& p, float length, bool lamp);  // along x
model::MeshBuilder wheelbarrow(const Palette& p);                       // its wheel towards +x
model::MeshBuilder bicycle(const Palette& p);                           // rides along +x
model::MeshBuilder shovel(const Palette& p);
model::MeshBuilder bucket(const Palette& p, uint32_t material, float height);
model::MeshBuilder ball(const Palette& p, float radius);  // about the origin
model::MeshBuilder slabStack(const Palette& p);
model::MeshBuilder bench(const Palette& p);
model::MeshBuilder flower(const Palette& p, uint32_t seed);  // a pot with a plant in it
model::MeshBuilder mast(const Palette& p, float height);

// A flag from the mast at (0, 0) along x, with its upper edge at y = 0, in a steady wind: a wave of amplitude `wave`
// (m) runs from hoist to fly, at `phase`.
struct FlagForm {
  float width = 1.5f, height = 0.95f, droop = 0.16f, wave = 0, phase = 0, flutter = 0;
};
model::Sheet flag(const FlagForm& form, uint32_t columns, uint32_t rows);

}  // namespace fovea::scene::yard
