// Where the probes of this frame lie, and which directions their rays take.
#include "sampling/random.glsl"
#include "records/probes.h"
#include "scene/scene.glsl"

layout(local_size_x = 64) in;

layout(std430) writeonly buffer RaysGridBlock { ProbeGrid value; } raysGrid;
layout(std430) writeonly buffer RaysDirectionsBlock { vec4 list[]; } raysDirections;
layout(std430) buffer CountersBlock { uint rays, probes, inside; } counters;

layout(push_constant) uniform Constants {
  uint probes;
  float spacing;
};

const float kGridRounding = 1e-3;  // of a cell
const float kGolden = 0.6180339887;

ProbeGrid gridOf(uint rays) {
  vec3 extent = frame.boundsMax - frame.boundsMin;
  float width = max(max(extent.x, max(extent.y, extent.z)) / float(probes), max(spacing, 1e-6));
  uvec3 cells = uvec3(clamp(ceil(extent / width - kGridRounding), vec3(1.0), vec3(float(probes))));
  vec3 origin = 0.5 * (frame.boundsMin + frame.boundsMax) - 0.5 * width * vec3(cells - 1u);
  return ProbeGrid(origin, width, cells.x, cells.y, cells.z, rays);
}

// A uniformly distributed rotation (Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992).
mat3 randomRotation(uint stream) {
  float first = uniformFloat(hashCombine(stream, 0u));
  float u = 2.0 * kPi * uniformFloat(hashCombine(stream, 1u)), v = 2.0 * kPi * uniformFloat(hashCombine(stream, 2u));
  float a = sqrt(1.0 - first), b = sqrt(first);
  float w = b * cos(v), x = a * sin(u), y = a * cos(u), z = b * sin(v);
  return mat3(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y),
              2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x),
              2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
}

void main() {
  uint i = gl_GlobalInvocationID.x, rays = uint(raysDirections.list.length());
  if (i >= rays) return;
  ProbeGrid grid = gridOf(rays);
  if (i == 0u) {
    raysGrid.value = grid;
    counters.probes = grid.columns * grid.rows * grid.layers;
  }
  float z = 1.0 - (2.0 * float(i) + 1.0) / float(rays), r = sqrt(1.0 - z * z);
  float phi = 2.0 * kPi * fract(float(i) * kGolden);
  mat3 turn_ = randomRotation(randomStream(frame.seed, frame.index, kProbeTurnStream, 0u));
  raysDirections.list[i] = vec4(turn_ * vec3(r * cos(phi), r * sin(phi), z), 0.0);
}
