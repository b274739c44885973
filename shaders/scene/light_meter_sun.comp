// How much of the light from one direction, infinitely far away, reaches the points of a light meter. It runs on the host
// (framework/host/light_meter.cpp). Define: RAY_PASSAGE as 1.
#include "rays/visibility.glsl"
#include "records/light_meter.h"

layout(local_size_x = 64) in;

LIST(readonly, MeterPoint, points);
LIST(writeonly, vec4, shares);  // rgb: share of the light, 0 in the background

layout(push_constant) uniform Constants {
  vec4 towards;  // xyz: unit
} constants;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(points.list.length())) return;
  MeterPoint point = points.list[i];
  vec3 share = vec3(0.0);
  if (point.there > 0.0) share = visibility(Ray(point.origin, vec3(constants.towards), 0.0, kFarAway));
  shares.list[i] = vec4(share, 0.0);
}
