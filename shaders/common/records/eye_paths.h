// The bundle `eye-paths`: diffuse paths from fixed points of the screen, one bounce each.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// What a screen point shows. All zeros stand for the background.
struct EyePathStart {
  vec3 position SHARED_ZERO;  // world space, m
  float there SHARED_ZERO;    // 1 if there is a surface
  vec3 normal SHARED_ZERO;    // shading normal, unit, on the side of the eye
  float unused0 SHARED_ZERO;
  vec3 face SHARED_ZERO;  // normal of the triangle, unit
  float unused1 SHARED_ZERO;
};
SHARED_SIZE(EyePathStart, 48)
SHARED_OFFSET(EyePathStart, face, 32)

// All zeros mean that the path hits nothing.
struct EyePathEnd {
  vec3 position SHARED_ZERO;  // world space, m
  // 1 without direct light of lamps, 2 with it, 3 where the surface emits more than it reflects of that, 4 where
  // emissive surfaces are about and it reflects more of other light than of that.
  float kind SHARED_ZERO;
  vec3 normal SHARED_ZERO;  // unit, on the side from which the path came
  // Number of cosine-weighted paths that this one stands for; 1 unless some paths are aimed at emissive surfaces.
  float weight SHARED_ZERO;
  vec3 radiance SHARED_ZERO;  // leaves towards the start of the path, W/(sr m^2)
  float unit SHARED_ZERO;  // unit of sums as whole numbers, W/(sr m^2), the same for all ends; see sumUnit()
};
SHARED_SIZE(EyePathEnd, 48)
SHARED_OFFSET(EyePathEnd, radiance, 32)

SHARED_END
