// What each ray of each probe meets, and the light found there. Defines: RAY_PASSAGE 0/1 (rays/trace.glsl); FEEDBACK
// 0/1, whether surfaces reflect the light that probes know.
#include "probes/light.glsl"
#include "rays/gather.glsl"

layout(local_size_x = 64) in;

VALUE(readonly, ProbeGrid, raysGrid);
LIST(readonly, vec4, raysDirections);
LIST(readonly, uint, shares);
LIST(writeonly, vec4, raysHits);
COUNTERS { uint rays, probes, inside; } counters;

layout(push_constant) uniform Constants { float bias; } constants;

// What ray `index` of all finds.
vec4 hitOf(vec3 origin, vec3 direction, uint index) {
  TracedSurface v = arrive(origin, direction, kFarAway);
  if (v.triangle == kNoTriangle)
    return vec4(hasEnvironmentMap() ? v.brighter * environmentRadiance(direction) : vec3(0.0), kFarAway);
  float distance_ = distance(v.position, origin);
  if (!v.there) return vec4(vec3(0.0), -kBackShortened * distance_);
  // Light that does not come from the scene's lights: what probes knew after the previous frame has one bounce more in
  // each frame.
#if FEEDBACK
  vec3 light = probeLight(raysGrid.value, constants.bias, v.position, v.normal, -direction);
#else
  uint stream = randomStream(frame.seed, frame.index, kProbeEmitterStream, 0u);
  vec3 light = gather(v, 0u, 1u, hashCombine(stream, index));
#endif
  vec3 rho = reflectance(v);
  return vec4(emitted(v) + diffuseLight(v, rho) + rho * light, distance_);
}

void main() {
  // An image of probes times rays, as there may be more than one dimension has.
  uint rays = uint(raysDirections.list.length()), ray = gl_GlobalInvocationID.x, probe = gl_GlobalInvocationID.y;
  if (ray >= rays) return;
  uint index = probe * rays + ray, share = shares.list[probe];
  vec4 hit = vec4(0.0);
  if (share > 0u && ray % share == 0u) {
    ProbeGrid grid = raysGrid.value;
    Probe state = loadProbe(probesStates, int(probe));
    vec3 origin = grid.origin + grid.spacing * vec3(probeCell(grid, int(probe))) + state.offset;
    hit = hitOf(origin, vec3(raysDirections.list[ray]), index);
    atomicAdd(counters.rays, rayCount);
  }
  raysHits.list[index] = hit;
}
