// Whether pixels show the same surface.
#ifndef FOVEA_SAME_SURFACE_GLSL
#define FOVEA_SAME_SURFACE_GLSL

#include "records/contact.h"

// position: of the pixel, m; face: normal of the plane near which the other point must lie; normal: normal from which the
// other's may differ only so much; other: xyz: m, w: above 0 unless background; tolerance: distance from the plane, m.
bool sameSurface(vec3 position, vec3 face, vec3 normal, vec4 other, vec3 otherNormal, float tolerance, float leastCos) {
  return other.w > 0.0 && abs(dot(vec3(other) - position, face)) <= tolerance && dot(normal, otherNormal) >= leastCos;
}

// Whether two points lie nearly on one plane, the same as in passes/same_plane.h.
bool onSamePlane(vec3 position, vec3 normal, vec3 otherPosition, vec3 otherNormal) {
  vec3 to = otherPosition - position;
  return dot(normal, otherNormal) > kSamePlaneCos && abs(dot(to, normal)) <= kSamePlaneSlope * length(to);
}

#endif
