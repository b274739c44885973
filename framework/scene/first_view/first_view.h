// What a picture needs and the file of a model does not say: a camera, a floor, enough light, and an exposure.
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

// Adds a camera if the scene has none, a floor if little is seen from that camera, light if most of what it shows would
// be dark, and the exposure with which that is neither dark nor burnt out.
FirstView addFirstView(Scene& scene);

// The parts of it. Each returns what it has added. `geometry` must be what flatten() made of the scene.

// A camera at the height of an eye where walls stand all around, if more of the scene is seen there than from outside;
// else one in front of the scene and above it, which shows the whole of it.
std::string addFirstCamera(Scene& scene, const Geometry& geometry);
// A floor under what the first camera sees, if that fills less than half of its picture: the smallest with which three
// fifths of it show something.
std::string addFirstFloor(Scene& scene, const Geometry& geometry);
// A sun and a sky; or, if no sun could reach what the first camera sees, a lamp above it. Nothing if at least half of
// what it sees is lit.
std::string addFirstLight(Scene& scene, const Geometry& geometry);
// The exposure with which the first camera's picture has a mean display value of about 0.45 and hardly any pixel is
// clipped, rounded to two digits. 1 if nothing is lit.
float firstExposure(const Scene& scene, const Geometry& geometry);

}  // namespace fovea::scene
