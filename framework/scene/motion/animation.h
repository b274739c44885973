// Animations as glTF 2.0 has them: the value of a channel at any time.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Seconds, of the animation: its last key.
float duration(const Animation& animation);

// Where in its keys an animation is at `time` of the scene.
float animationTime(const Animation& animation, double time);

// Floats that one key holds of each of value and tangents: 3, 4 for rotations, else one a morph target. 0 for
// a channel that has no keys or whose numbers do not add up.
size_t componentsOf(const AnimationChannel& channel);

// The value at `time` (s, of the keys; held before the first and after the last one): componentsOf() floats.
// Rotations are unit quaternions (x, y, z, w), between LINEAR keys by spherical interpolation along the
// shorter way. glTF 2.0, appendix C.
void sampleChannel(const AnimationChannel& channel, float time, std::span<float> value);

}  // namespace fovea::scene
