// The pieces of which the room is built. Private to room*.cpp. Lengths are in metres; each piece stands on y = 0
// about the origin and looks along +z unless stated otherwise.
#pragma once

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::room {

// Materials of the scene, as returned by SceneBuilder::material. `..Across` means that the grain runs along x.
struct Palette {
  uint32_t wall, ceiling, paint, outside, floor, gap, red, redDeep, oak, oakAcross, birch, birchAcross, rug,
      fringe, linen, blanket, curtain, brass, iron, paper, shade, leaf, hedge, soil, clay, bark, plush,
      plushPale, wicker, globe, picture[3], drawing;
  uint32_t cloth[6];  // orange, teal, striped, white, rose, navy
  uint32_t book[7];
  uint32_t toy[6];  // red, blue, green, yellow, orange, white
};
Palette makePalette(model::SceneBuilder& builder);

inline constexpr glm::vec2 kRug{2.36f, 1.72f};
inline constexpr float kRugHeight = 0.014f;

// Furniture.
model::Shape knob(float radius);
model::MeshBuilder closet(const Palette& p);  // back at z = 0; its right door stands open
model::MeshBuilder bookcase(const Palette& p);
model::MeshBuilder daybed(const Palette& p);  // lies along x, back at z = 0
model::MeshBuilder floorLamp(const Palette& p);
model::MeshBuilder pendant(const Palette& p);  // hangs from the origin
model::MeshBuilder table(const Palette& p);
model::MeshBuilder chair(const Palette& p);
model::MeshBuilder drawers(const Palette& p);
model::MeshBuilder pictureFrame(const Palette& p, uint32_t picture, float width, float height);
model::MeshBuilder rug(const Palette& p);
model::MeshBuilder windowFrame(const Palette& p, float width, float height);  // hole from the origin up
model::MeshBuilder curtainRod(const Palette& p, float width);                 // middle at the origin

// A curtain on rings from (0, 0) to (width, 0), falling to -height. `gather` (0..1) is how far it is tied back to its
// outer edge x = 0. `billow`, `wave` (m) and `phase` describe the effect of the draught.
struct CurtainForm {
  float width = 0.7f, height = 1.8f, gather = 0, billow = 0, wave = 0, phase = 0, folds = 6;
  uint32_t seed = 1;
};
model::Sheet curtain(const CurtainForm& form, uint32_t columns, uint32_t rows);

// Toys. The train runs along its +x with its wheels on y = 0.
model::MeshBuilder locomotive(const Palette& p);
model::MeshBuilder tender(const Palette& p);
model::MeshBuilder coach(const Palette& p);
model::MeshBuilder track(const Palette& p);  // the whole oval, lying on y = 0
model::MeshBuilder tunnel(const Palette& p);
model::MeshBuilder toyTree(const Palette& p, float height);
model::MeshBuilder teddy(const Palette& p);
model::MeshBuilder globe(const Palette& p);
model::MeshBuilder ball(const Palette& p, float radius);
model::MeshBuilder basket(const Palette& p);
model::MeshBuilder castle(const Palette& p);  // of building blocks
model::MeshBuilder stackingRings(const Palette& p);
model::MeshBuilder pottedPlant(const Palette& p, uint32_t seed);
model::MeshBuilder openBook(const Palette& p);
model::MeshBuilder bunting(const Palette& p, float width, float sag);  // from the origin along +x

// The oval of the track: two straights of length 2 * kHalfStraight along x and two half circles of radius kBend.
// `distance` is measured along it from the middle of the straight at +z, which is passed in the direction +x.
inline constexpr float kHalfStraight = 0.42f, kBend = 0.56f, kRailTop = 0.0162f;
struct TrackPoint {
  glm::vec3 position;
  float turnYDegrees;
};
float trackLength();
TrackPoint trackAt(float distance);

}  // namespace fovea::scene::room
