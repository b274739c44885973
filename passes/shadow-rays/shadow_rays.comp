// Direct light at the pixels for which the shadow maps are in doubt, found anew by rays through the triangles. Defines:
// GLOSS 0/1 (direct/receiver.glsl) and RAY_PASSAGE (rays/trace.glsl), 1 for full materials.
#include "rays/visibility.glsl"
#include "direct/receiver.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

IMAGE(rgba16f, restrict, image2D, direct);
COUNTERS { uint pixels, rays; } counters;

layout(push_constant) uniform Constants {
  ivec4 fine;  // corners of the part of the picture where pixels are decided
} constants;

vec3 lightFrom(LightRecord light, Receiver r, vec3 origin) {
  LightSample e = sampleLight(light, vec3(r.place));
  if (dot(r.normal, e.direction) <= 0.0 || dot(r.face, e.direction) <= 0.0 || e.irradiance == vec3(0.0))
    return vec3(0.0);
  atomicAdd(counters.rays, 1u);
  float end = e.distance < kFarAway ? e.distance * kShadowEnd : kFarAway;
  return visibility(Ray(origin, e.direction, 0.0, end)) * response(r, e);
}

// The light of a pixel that shows a surface.
vec3 tracedLight(ivec2 p) {
  Receiver r = receiverAt(p);
  vec3 sum = vec3(0.0), origin = vec3(r.place) + (r.face + normalize(view.eye - vec3(r.place))) * rayEpsilon();
  for (uint i = 0u; i < frame.lightCount; ++i) sum += lightFrom(lights[i], r, origin);
  return radianceOf(r, sum);
}

void main() {
  ivec2 p = ivec2(constants.fine) + ivec2(gl_GlobalInvocationID);
  if (any(greaterThanEqual(p, ivec2(constants.fine.z, constants.fine.w)))) return;
  vec4 before = imageLoad(direct, p);
  if (before.a == 1.0) return;
  atomicAdd(counters.pixels, 1u);
  bool background = !(imageLoad(gbufferDistance, p).r > 0.0);
  imageStore(direct, p, vec4(background ? vec3(before) : tracedLight(p), 1.0));
}
