// How the lights see the scene: the bundle `shadow-maps` (vpls/shadow.glsl).
#pragma once

#include "scene.h"

SHARED_BEGIN(fovea::scene)

SHARED_CONSTANT uint kMaxShadowLayers =
    576u;  // of 96 point lights; the views fit into a uniform block of 64 KiB

// Projection of one layer. Depth is reversed (1: nearest to the light, 0: farthest, and where nothing is hit). With
// near / z a 32-bit float has the same relative precision at every distance, and no far plane is needed.
struct ShadowView {
  mat4 worldToClip SHARED_ZERO;
  vec3 right SHARED_ZERO;        // unit, image x axis in the world
  float texelWidth SHARED_ZERO;  // where clip.w = 1, m
  vec3 up SHARED_ZERO;           // unit, image y axis
  float texelHeight SHARED_ZERO;
  float bias SHARED_ZERO;  // tolerance of depths for rounding: absolute, and
  float relativeBias SHARED_ZERO;
  float depthScale SHARED_ZERO;  // 1 / depth range, 1/m, or for a perspective the near distance, m
  float unused SHARED_ZERO;
};
SHARED_SIZE(ShadowView, 112)
SHARED_OFFSET(ShadowView, right, 64)
SHARED_OFFSET(ShadowView, bias, 96)

SHARED_END
