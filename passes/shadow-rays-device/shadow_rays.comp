// Direct light anew at the pixels in doubt, with rays through the triangles. Defines: GLOSS 0/1 (direct/receiver.glsl)
// and RAY_PASSAGE (rays/trace.glsl), 1 for full materials.
#include "rays/visibility.glsl"
#include "direct/receiver.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba16f) uniform image2D direct;
layout(std430) buffer CountersBlock { uint pixels, rays; } counters;

layout(push_constant) uniform Constants {
  ivec4 fine;  // corners of the part of the picture where pixels are decided
};

vec3 lightFrom(LightRecord light, Receiver r, vec3 origin) {
  LightSample e = sampleLight(light, r.place.xyz);
  if (dot(r.normal, e.direction) <= 0.0 || dot(r.face, e.direction) <= 0.0 || e.irradiance == vec3(0.0))
    return vec3(0.0);
  atomicAdd(counters.rays, 1u);
  float end = e.distance < kFarAway ? e.distance * kShadowEnd : kFarAway;
  return visibility(Ray(origin, e.direction, 0.0, end)) * response(r, e);
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(direct)))) return;
  if (any(lessThan(p, fine.xy)) || any(greaterThanEqual(p, fine.zw))) return;
  vec4 before = imageLoad(direct, p);
  if (before.a == 1.0) return;
  atomicAdd(counters.pixels, 1u);
  Receiver r = receiverAt(p);
  vec3 sum = vec3(0.0), origin = r.place.xyz + (r.face + normalize(view.eye - r.place.xyz)) * rayEpsilon();
  uint lightCount = r.place.w > 0.0 ? frame.lightCount : 0u;
  for (uint i = 0u; i < lightCount; ++i) sum += lightFrom(lights[i], r, origin);
  imageStore(direct, p, vec4(r.place.w > 0.0 ? radianceOf(r, sum) : before.rgb, 1.0));
}
