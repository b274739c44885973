#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Direct light on the voxels: L = rho E / pi + emission for every side, E averaged over several points of its surface.
#include "common/scene.glsl"
#include "common/random.glsl"
#include "common/voxel_trace.glsl"
#if SHADOWED
#define SHADOW_BINDING 8
#include "common/shadow.glsl"
#endif

layout(local_size_x = 64) in;

layout(set = 0) uniform usamplerBuffer voxelsInfo;
layout(set = 0, std430) writeonly buffer Radiance { vec4 sides[]; } radiance;

layout(push_constant) uniform Constants {
  int taps;
  float offset;  // cells
};

const uint kLightInject = 0x11c7u;  // of the random numbers

// Where a side's surface lies in its cell: two axes across, one along the largest component of the normal. As far from
// the average position as the nearer wall of the cell allows in each axis, and no more than its area: exact for a surface
// that fills the cell or a part that begins at a wall of the cell, as at the edges and corners of planes.
struct Patch {
  vec3 u, v;    // half axes in the tangent plane, m
};

vec3 toAxes(uint axis, vec3 p) { return axis == 0u ? p.yzx : axis == 1u ? p.zxy : p; }
vec3 fromAxes(uint axis, vec3 p) { return axis == 0u ? p.zxy : axis == 1u ? p.yzx : p; }

Patch patchOf(VoxelGrid grid, VoxelSide side) {
  vec3 low = voxelToWorld(grid, floor(worldToVoxel(grid, side.position)));
  vec3 reach = max(min(side.position - low, low + grid.cell - side.position), 0.0);
  vec3 a = abs(side.normal);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  vec3 n = toAxes(axis, side.normal), r = toAxes(axis, reach);
  float widest = 4.0 * r.x * r.y / max(abs(n.z), 0.1);
  r.xy *= min(1.0, sqrt(side.area / max(widest, 1e-30)));
  vec2 rise = -n.xy / (n.z >= 0.0 ? max(n.z, 0.1) : min(n.z, -0.1));
  return Patch(fromAxes(axis, vec3(r.x, 0.0, r.x * rise.x)), fromAxes(axis, vec3(0.0, r.y, r.y * rise.y)));
}

// Irradiance of a side by one light, averaged over a lattice of points (Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018) that starts at `first`. The light is the outer loop: what it takes to load it counts.
vec3 irradianceBy(Light light, VoxelSide side, Patch area, vec2 first, float cell) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < taps; ++i) {
    vec2 p = 2.0 * fract(first + float(i) * vec2(0.7548776662, 0.5698402910)) - 1.0;
    vec3 position = side.position + p.x * area.u + p.y * area.v;
    LightSample incoming = sampleLight(light, position);
    float cosine = dot(side.normal, incoming.direction);
    if (cosine <= 0.0 || incoming.irradiance == vec3(0.0)) continue;
#if SHADOWED
    // The tangent plane cuts through the surface where that is curved or has an edge.
    cosine *= lightVisibility(light, firstShadowLayer(light), position + side.normal * (offset * cell), side.normal);
#endif
    sum += incoming.irradiance * cosine;
  }
  return sum / float(taps);
}

void main() {
  // The first half of the invocations takes the sides 0, the second the sides 1: most voxels have but one, and
  // neighbours with the same fate run together.
  uint voxels = texelFetch(voxelsInfo, 0).x;
  uint id = gl_GlobalInvocationID.x;
  if (id >= 2u * voxels) return;
  uint number = id < voxels ? 2u * id : 2u * (id - voxels) + 1u;
  VoxelSide side = loadSide(number);
  vec3 result = vec3(0.0);
  if (side.area > 0.0) {
    VoxelGrid grid = voxelsGrid();
    Patch area = patchOf(grid, side);
    // The points start anew for each cell; by the cell and not by the number of the voxel, which changes when
    // something moves.
    uvec3 cell = uvec3(max(worldToVoxel(grid, side.position), vec3(0.0)));
    uint bits = randomStream(kLightInject, cell.x, cell.y, 2u * cell.z + (number & 1u));
    vec2 first = vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)));
    vec3 irradiance = vec3(0.0);
    for (uint i = 0u; i < frame.lightCount; ++i) irradiance += irradianceBy(lights[i], side, area, first, grid.cell);
    result = side.reflectance * irradiance / kPi + side.emission;
  }
  radiance.sides[number] = vec4(result, dot(result, vec3(0.2126, 0.7152, 0.0722)));
}
