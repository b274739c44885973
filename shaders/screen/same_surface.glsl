// Whether pixels show the same surface.
#ifndef FOVEA_SAME_SURFACE_GLSL
#define FOVEA_SAME_SURFACE_GLSL

#include "records/contact.h"

// Whether another point lies near the plane of a pixel's surface and has a similar normal. position: of the pixel,
// world space, m; face: unit normal of the plane; normal: unit normal with which the other's is compared; other: xyz:
// world space, m, w: above 0 unless it is background; tolerance: greatest distance from the plane, m; leastCos: least
// cosine between the normals.
bool sameSurface(vec3 position, vec3 face, vec3 normal, vec4 other, vec3 otherNormal, float tolerance, float leastCos) {
  return other.w > 0.0 && abs(dot(vec3(other) - position, face)) <= tolerance && dot(normal, otherNormal) >= leastCos;
}

// Whether two points, world space, m, with unit normals lie nearly on one plane (kSamePlaneCos, kSamePlaneSlope).
bool onSamePlane(vec3 position, vec3 normal, vec3 otherPosition, vec3 otherNormal) {
  vec3 to = otherPosition - position;
  return dot(normal, otherNormal) > kSamePlaneCos && abs(dot(to, normal)) <= kSamePlaneSlope * length(to);
}

#endif
