#extension GL_KHR_shader_subgroup_arithmetic : require
// Processes the listed tiles, those with pixels without a source. Such a pixel takes the light of pixels on its
// surface that have a source, at most FILL pixels away and in its tile; these are nearer than the interleaved samples
// that shading would gather. If there are none, its whole block is shaded. One tile per work group. Defines:
// INTERLEAVE, pixels per side of a block; FILL, 0 if no pixels are filled.
#include "screen/same_surface.glsl"
#include "scene/scene.glsl"
#include "reproject/records.h"
#include "screen/gbuffer.glsl"

const int kBlocksPerSide = kTile / INTERLEAVE;
const uint kThreads = 16u, kPixels = uint(kTile * kTile), kBlocks = uint(kBlocksPerSide * kBlocksPerSide);

layout(local_size_x = 16) in;  // few, as on a CPU device each subgroup of a group with barriers has a cost

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(rgba16f) uniform image2D irradiance;
layout(r8) uniform writeonly image2D shadeMask;
layout(std430) writeonly buffer TileBlocks { uint count[]; } tileBlocks;
layout(std430) readonly buffer OpenList { uint list[]; } openList;
layout(std430) buffer Counters { uint counters[]; };  // pixels, new, filled, shaded

layout(push_constant) uniform Constants {
  float planeTolerance;  // relative to the distance from the eye
  float leastCos;
};

shared vec4 tile[kPixels];  // irradiance; a: 1 where it has a source
shared uint open[kPixels];  // pixels of the tile without a source
shared uint openCount, blocks;
shared uint newInBlock[kBlocks];

ivec2 placeOf(uint index) { return ivec2(int(index) % kTile, int(index) / kTile); }

uint blockOf(uint index) {
  ivec2 block = placeOf(index) / INTERLEAVE;
  return uint(block.y * kBlocksPerSide + block.x);
}

// Mean over the surrounding pixels of the same surface, with nearer ones weighted more; a: 0 if there are none.
vec4 fromNeighbours(ivec2 corner, ivec2 local) {
  vec4 sum = vec4(0.0);
  vec3 origin = vec3(0.0);
  vec4 position = surfaceAt(corner + local);
  vec3 normal = imageLoad(gbufferNormal, corner + local).xyz,
       face = octDecode(imageLoad(gbufferFace, corner + local).xy);
  float tolerance = planeTolerance * position.w;
  const int kSide = 2 * FILL + 1;
  for (int i = 0; i < kSide * kSide; ++i) {
    ivec2 d = ivec2(i % kSide, i / kSide) - FILL, q = local + d;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, ivec2(kTile)))) continue;
    vec4 value = tile[q.y * kTile + q.x];
    if (value.a == 0.0) continue;
    bool same = sameSurface(position.xyz, face, normal, surfaceAt(corner + q),
                            imageLoad(gbufferNormal, corner + q).xyz, tolerance, leastCos);
    if (!same) continue;
    if (sum.a == 0.0) origin = value.rgb;
    float w = 1.0 / float(d.x * d.x + d.y * d.y);
    sum += w * vec4(value.rgb - origin, 1.0);
  }
  return vec4(origin + sum.rgb / max(sum.a, 1e-12), sum.a);
}

void main() {
  if (gl_WorkGroupID.x + 1u == gl_NumWorkGroups.x) return;  // there is one group more than tiles
  uint thread = gl_LocalInvocationIndex, listed = openList.list[gl_WorkGroupID.x];
  ivec2 size = imageSize(irradiance);
  uint columns = uint((size.x + kTile - 1) / kTile);
  ivec2 corner = ivec2(listed % columns, listed / columns) * kTile;
  for (uint i = thread; i < kBlocks; i += kThreads) newInBlock[i] = 0u;
  if (thread == 0u) openCount = blocks = 0u;
  barrier();

  for (uint i = thread; i < kPixels; i += kThreads) {
    ivec2 p = corner + placeOf(i), inside = min(p, size - 1);
    vec4 light = imageLoad(irradiance, inside);
    bool surface = p == inside && imageLoad(gbufferDistance, inside).r > 0.0;
    tile[i] = surface ? light : vec4(0.0);
    if (surface && light.a == 0.0) open[atomicAdd(openCount, 1u)] = i;
  }
  barrier();

  uint filled = 0u;
  for (uint item = thread; item < openCount; item += kThreads) {
    uint i = open[item];
    vec4 light = fromNeighbours(corner, placeOf(i));
    if (light.a > 0.0) {
      ++filled;
      imageStore(irradiance, corner + placeOf(i), vec4(light.rgb, 0.5));
    } else {
      atomicOr(newInBlock[blockOf(i)], 1u);
    }
  }
  barrier();

  uint shaded = 0u;
  for (uint i = thread; i < kPixels; i += kThreads) {
    ivec2 p = corner + placeOf(i);
    if (newInBlock[blockOf(i)] == 0u || any(greaterThanEqual(p, size))) continue;
    imageStore(shadeMask, p, vec4(1.0));
    if (imageLoad(gbufferDistance, p).r > 0.0) ++shaded;
  }
  for (uint i = thread; i < kBlocks; i += kThreads)
    if (newInBlock[i] != 0u) atomicAdd(blocks, 1u);
  barrier();
  if (thread == 0u) tileBlocks.count[listed] = blocks;
  filled = subgroupAdd(filled);
  shaded = subgroupAdd(shaded);
  if (subgroupElect() && filled > 0u) atomicAdd(counters[2], filled);
  if (subgroupElect() && shaded > 0u) atomicAdd(counters[3], shaded);
}
