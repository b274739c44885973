// Strategies `pdf` and `constant`: the share of the eye paths that hit a surface, from one diffuse bounce at each of
// the first screen points, the same ones as long as nothing moves. Counting this frame's candidates instead would
// make a still image flicker.
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"
#include "vpls/paraboloid.glsl"
#include "sampling/diffuse_bounce.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer screen;
layout(std430) buffer TotalsBlock { Totals value; } totals;

layout(push_constant) uniform Constants { uint escapePoints; };

const uint kEscapeStream = 0x65736361u;

void main() {
  uint point = gl_GlobalInvocationID.x;
  if (point >= escapePoints) return;
  EyePathStart from = loadStart(screen, point);
  if (!(from.there > 0.0)) return;
  vec2 u = streamPoint(randomStream(0u, 0u, kEscapeStream, point), 0u);
  vec3 direction = diffuseBounce(from.normal, from.face, u);  // as in pass candidates
  if (traceVoxels(voxelsGrid(), from.position, direction, from.face).side != kNoSide) atomicAdd(totals.value.found, 1u);
}
