// What a picture needs and the file of a model lacks: a camera, a floor, enough light, and an exposure.
#pragma once

#include <string>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Reflectance of a floor that is added, and of the ground below a sky that is added, which continues it.
inline constexpr float kGroundReflectance = 0.3f;

// What has been added to a scene, in words; empty where nothing was.
struct FirstView {
  std::string camera, floor, light, exposure;
};

// Adds a camera if the scene has none, a floor if little is visible from that camera, light if most of the view would
// be dark, and an exposure with which the view is neither dark nor overexposed.
FirstView addFirstView(Scene& scene);

// Its parts. Each returns what it has added. `geometry` must be the result of flatten() for the scene.

// A camera at eye height inside surrounding walls, if it shows more of the scene than a view from outside; else one in
// front of the scene and above it, which shows the whole scene.
std::string addFirstCamera(Scene& scene, const Geometry& geometry);
// Puts a floor under the scene if the first camera stands outside of it and would see ground around it, or if the
// camera stands inside and surfaces fill less than half of its picture. The floor is the smallest one that catches the
// shadow of the scene and with which surfaces fill three fifths of the picture.
std::string addFirstFloor(Scene& scene, const Geometry& geometry);
// A sun and a sky; or a lamp, if no sun could reach the surfaces that the first camera sees. Nothing if light reaches
// at least half of them, be it that of lights, of emissive surfaces or of an environment, and, where there are no lamps
// and most of them are emissive or unlit, also the floor that was added, which is the last node.
std::string addFirstLight(Scene& scene, const Geometry& geometry, bool floorAdded = false);
// Whether no light reaches the floor that was added, so that it would only be a black disc.
bool firstFloorIsDark(const Scene& scene, const Geometry& geometry);
// The exposure with which the first camera's picture has a mean display value of about 0.45 and hardly any pixel is
// clipped, rounded to two digits. 1 if nothing is lit.
float firstExposure(const Scene& scene, const Geometry& geometry);

}  // namespace fovea::scene
