// A part of the light of each listed pixel: that of one ray. Define: RAY_PASSAGE 0/1
// (rays/trace.glsl).
#define MAP_ALONE 0
#include "rays/near_light.glsl"
#include "screen/history.glsl"

layout(local_size_x = 64) in;  // kItemsInGroup

LIST(readonly, uint, items);
VALUE(readonly, uint, listed);
IMAGE(rgba32f, restrict, image2D, traced);
LIST(readonly, vec4, spread);
COUNTERS { uint rays, pixels; } counters;

layout(push_constant) uniform Constants {
  uint samples;
  uint bounces;
  float reach;
  uint turn_;  // number of this ray, from 0 on in each frame: without a mean over frames, new rays would flicker
} constants;

CONSTANT uint kEmitterPoints = 4u;

float discArea() { return spread.list[0].x; }
float reach() { return constants.reach; }
void noteLength(float distance_, float probability) {}
vec3 furtherLight(TracedSurface v, uint bounces, uint stream) { return gather(v, bounces, 1u, stream); }
float underLobe(vec3 direction, float cosine) { return 1.0; }

void main() {
  uint number = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (number >= listed.value) return;
  ivec2 pixel = unpackPixel(items.list[number]);
  TracedSurface v = look(vec2(pixel) + 0.5);
  vec4 light = constants.turn_ > 0u ? imageLoad(traced, pixel) : vec4(vec3(0.0), float(v.there));
  if (v.there)
    light += vec4(nearLight(v, uvec2(pixel), constants.turn_, constants.bounces, kEmitterPoints).light /
                      float(constants.samples),
                  0.0);
  atomicAdd(counters.rays, rayCount);
  if (v.there && constants.turn_ == 0u) atomicAdd(counters.pixels, 1u);
  imageStore(traced, pixel, light);
}
