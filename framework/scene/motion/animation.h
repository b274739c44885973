// Evaluates animations as defined by glTF 2.0: the value of a channel at any time.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Duration in seconds of the animation: the time of its last key.
float duration(const Animation& animation);

// Position in its keys, in seconds, at which an animation is at `time` of the scene.
float animationTime(const Animation& animation, double time);

// Number of floats that one key holds for each of value and tangents: 4 for rotations, one per morph target for
// weights, otherwise 3. 0 for a channel that has no keys or whose array sizes are inconsistent.
size_t componentsOf(const AnimationChannel& channel);

// Writes the value at `time` (seconds on the time line of the keys) to componentsOf() floats. The value is constant
// before the first key and after the last one. Rotations are unit quaternions (x, y, z, w); between LINEAR keys they
// are interpolated spherically along the shorter arc. glTF 2.0, appendix C.
void sampleChannel(const AnimationChannel& channel, float time, std::span<float> value);

}  // namespace fovea::scene
