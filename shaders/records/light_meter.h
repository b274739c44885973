// What a light meter finds at a pixel of the first camera's picture (scene/light_meter.comp).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

struct MeterPoint {
  vec3 position SHARED_ZERO;  // of the surface, world space, m
  float there SHARED_ZERO;    // 1: the pixel shows a surface; 0: the background
  vec3 origin SHARED_ZERO;    // start of rays that leave the surface
  float arriving
      SHARED_ZERO;          // irradiance / pi in the brightest channel: the radiance of a white surface there
  vec3 normal SHARED_ZERO;  // of shading, unit, on the side of the camera
  float emitted SHARED_ZERO;  // the part of the radiance that the surface emits, in the brightest channel
  vec3 radiance SHARED_ZERO;  // towards the camera, W/(sr m^2)
  float unused SHARED_ZERO;
};
SHARED_SIZE(MeterPoint, 64)
SHARED_OFFSET(MeterPoint, radiance, 48)

SHARED_END
