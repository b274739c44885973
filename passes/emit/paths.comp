// Light paths, one per invocation, with a VPL at every hit (Keller 1997). In a round (`stores` 0) only the number of
// VPLs of each path is found, by which `accept` chooses the paths that count; those are traced once more to store them,
// by the same code, so that rounding cannot make them longer. Define: RAY_PASSAGE 0 (rays/trace.glsl).
#include "emit/sources.glsl"
#include "sampling/sobol.glsl"
#include "records/light_paths.h"
#include "records/vpl.h"

layout(local_size_x = 64) in;  // kLightPathGroup

VALUE(readonly, LightPaths, progress);
LIST(readonly, float, shares);
LIST(writeonly, uint, lengths);
LIST(readonly, uint, starts);
LIST(writeonly, Vpl, found);
COUNTERS { uint paths, rays, vpls, escaped; } counters;

layout(push_constant) uniform Constants {
  uint stores;
  uint perFrame;
} constants;

// Shading normals redistribute the light that arrives: a gathering renderer weights it by cos_shading, but particles
// are counted by cos_geometric (Veach 1997, section 5.3). The bound keeps single VPLs from becoming too bright.
CONSTANT float kMaxNormalCorrection = 4.0;

uint slot = 0u;    // of the path's first VPL
uint length_ = 0u; // VPLs so far
bool escapes = false;

void store(vec3 position, vec3 normal, vec3 flux) {
  if (flux == vec3(0.0)) return;
  if (constants.stores != 0u)
    found.list[slot + length_] = Vpl(position, 0.0, normal, 0.0, flux / (kPi * float(progress.value.paths)), 0.0);
  ++length_;
}

// The first light whose sum of powers exceeds x.
uint lightAt(float x) {
  uint low = 0u, high = frame.lightCount - 1u;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (shares.list[middle] > x) high = middle;
    else low = middle + 1u;
  }
  return low;
}

// The first four dimensions of the quasi-random numbers are for the source, the next four for the direction from a
// surface.
Emission emission(uint index, uint seed) {
  float lightPower = progress.value.lightPower, power = progress.value.power, x = sobol(index, 0u, seed) * power;
  vec3 u = vec3(sobol(index, 1u, seed), sobol(index, 2u, seed), sobol(index, 3u, seed));
  float surfaces = power - lightPower;
  if (x >= lightPower && surfaces > 0.0) {
    vec2 turn_ = vec2(sobol(index, 4u, seed), sobol(index, 5u, seed));
    return fromTriangle(surfaces / power, (x - lightPower) / surfaces, u, turn_);
  }
  LightRecord light = lights[lightAt(x)];
  return fromLight(light, meanChannel(powerOf(light)) / power, u);
}

// The window of KHR_lights_punctual.
float rangeWindow(float distance_, float range) {
  float x = range > 0.0 ? distance_ / range : 0.0;
  return clamp(1.0 - x * x * x * x, 0.0, 1.0);
}

void tracePath(uint index) {
  uint seed = randomStream(frame.seed, constants.perFrame != 0u ? frame.index : 0u, kLightPathStream, 0u);
  Emission start = emission(index, seed);
  Ray ray = start.ray;
  vec3 flux = start.flux;
  if (start.isSurface) store(ray.origin, start.normal, flux);
  for (uint bounce = 1u; bounce <= progress.value.bounces; ++bounce) {
    ++rayCount;
    RayHit hit = intersect(ray);
    escapes = hit.triangle == kNoTriangle;
    if (escapes) return;
    if (bounce == 1u) flux *= rangeWindow(hit.distance, start.range);
    TracedSurface v = surfaceOf(hit, ray.direction);
    float cosGeometric = -dot(v.face, ray.direction), cosShading = -dot(v.normal, ray.direction);
    if (!(cosShading > 0.0 && cosGeometric > 0.0)) return;
    vec3 rho = clamp(vec3(materialReflectance(v.material, v.uv)), 0.0, 1.0);
    flux *= rho * min(cosShading / cosGeometric, kMaxNormalCorrection);
    store(v.position, v.face, flux);
    // Keller's termination: the path survives with a probability equal to the surface's reflectivity, so its flux does
    // not shrink.
    float survival = max(rho.r, max(rho.g, rho.b));
    uint dimension = 4u * (bounce + 1u);
    if (sobol(index, dimension + 2u, seed) >= survival) return;
    flux /= survival;
    vec2 u = vec2(sobol(index, dimension, seed), sobol(index, dimension + 1u, seed));
    ray = Ray(v.position + v.face * rayEpsilon(), normalize(cosineDirection(v.face, u)), 0.0, kFarAway);
  }
}

void main() {
  uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * kLightPathColumns * kLightPathGroup;
  if (constants.stores == 0u) {
    if (i >= progress.value.count) return;
    tracePath(progress.value.first + i);
    lengths.list[i] = length_;
    if (escapes) atomicAdd(counters.escaped, 1u);
  } else {
    if (i >= progress.value.stored || starts.list[i] == 0u) return;
    slot = i;
    tracePath(starts.list[i] - 1u);
  }
  atomicAdd(counters.rays, rayCount);
}
