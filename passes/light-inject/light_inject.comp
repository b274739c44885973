// Direct light on the voxels: L = rho E / pi + emission for every listed side, with E averaged over several points of
// its surface. Defines: SHADOWED 0/1; SHADOW_FILTER; ONE_LIGHT 0/1/2 as in direct.frag.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "sampling/random.glsl"
#include "voxels/voxel_trace.glsl"
#if SHADOWED
#define SHADOW_MAPS 1
#if ONE_LIGHT == 2
#define SHADOW_LAYER 0u
#endif
#include "vpls/shadow.glsl"
#endif
#include "light-inject/patch.glsl"

layout(local_size_x = 64) in;  // kSidesPerGroup

layout(std430) buffer Radiance { vec4 sides[]; } radiance;
layout(std430) writeonly buffer Changed { uint sides[]; } changed;
layout(std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
uniform usamplerBuffer work;    // see select.comp
LARGE_TEXELS(uint, listed);

layout(push_constant) uniform Constants {
  int taps;      // of each light
  float offset;  // cells
};

const uint kLightInject = 0x11c7u;  // random stream

// Irradiance of a side from one light, averaged over a lattice of points (Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018) that starts at `first`. The light is the outer loop, as loading it is costly, and each
// of them has other points of the lattice.
vec3 irradianceBy(LightRecord light, int index, VoxelSide side, Patch area, vec2 first, float cell) {
  vec3 sum = vec3(0.0);
  for (int i = index * taps; i < (index + 1) * taps; ++i) {
    vec2 p = 2.0 * fract(first + float(i) * vec2(0.7548776662, 0.5698402910)) - 1.0;
    vec3 position = side.position + p.x * area.u + p.y * area.v;
    LightSample incoming = sampleLight(light, position);
    float cosine = dot(side.normal, incoming.direction);
    if (cosine <= 0.0 || incoming.irradiance == vec3(0.0)) continue;
#if SHADOWED
    // The offset is needed because the tangent plane cuts through surfaces that are curved or have an edge.
    cosine *= lightVisibility(light, light.firstShadowLayer, position + side.normal * (offset * cell), side.normal);
#endif
    sum += incoming.irradiance * cosine;
  }
  return sum / float(taps);
}

// rgb: outgoing radiance, a: its luminance.
vec4 radianceOf(VoxelGrid grid, VoxelSide side, Patch area, uint which) {
  // The points depend on the cell and not on the number of the voxel, which changes when something moves.
  uvec3 cell = uvec3(max(worldToVoxel(grid, side.position), vec3(0.0)));
  uint bits = randomStream(kLightInject, cell.x, cell.y, 2u * cell.z + which);
  vec2 first = vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)));
  vec3 irradiance = vec3(0.0);
#if ONE_LIGHT
  irradiance = irradianceBy(lights[0], 0, side, area, first, grid.cell);
#else
  for (uint i = 0u; i < frame.lightCount; ++i)
    irradiance += irradianceBy(lights[i], int(i), side, area, first, grid.cell);
#endif
  vec3 result = side.reflectance * irradiance / kPi;
#if EMISSION
  result += side.emission;
#endif
  return vec4(result, dot(result, vec3(0.2126, 0.7152, 0.0722)));
}

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= texelFetch(work, 0).w) return;
  uint number = texelOf(listed, int(place)).x;
  VoxelSide side = loadSide(number);
  VoxelGrid grid = voxelsGrid();
  vec4 now = side.area > 0.0 ? radianceOf(grid, side, patchOf(grid, side), number & 1u) : vec4(0.0);
  bool stays = number / 2u < voxelsInfo.value.staticVoxels &&
               floatBitsToUint(now) == floatBitsToUint(radiance.sides[number]);
  radiance.sides[number] = now;
  changed.sides[number] = stays ? 0u : 1u;
}
