#extension GL_KHR_shader_subgroup_ballot : require
// Warps the irradiance of the first eye to the surfaces that the second eye sees. The point of a pixel is projected
// into the source image. Of the four texels around it, those that show the same surface count (near the tangent plane
// of the pixel, with similar normals), with bilinear weights. A pixel with too small a weight has no source; the
// tiles that contain such pixels are listed for fill.comp. Defines: NEAR_FIELD 0/1, whether the light from nearby
// surfaces, a part of the irradiance, is also warped on its own.
#include "screen/same_surface.glsl"
#include "screen/taps.glsl"
#include "scene/scene.glsl"
#include "reproject/records.h"
#include "screen/gbuffer.glsl"

layout(local_size_x = kRowWidth) in;

// Images rather than textures, because on a CPU device a load from a texture costs several times as much.
SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rg16_snorm) uniform readonly image2D gbufferFace;
SURFACES(sourceGbuffer, sourceAt)
layout(rgba16f) uniform readonly image2D sourceGbufferNormal;
layout(rgba16f) uniform readonly image2D sourceIrradiance;
layout(rgba16f) uniform writeonly image2D irradiance;
#if NEAR_FIELD
layout(rgba16f) uniform readonly image2D sourceNearField;
layout(rgba16f) uniform writeonly image2D nearField;
#endif
layout(std430) buffer TileBlocks { uint count[]; } tileBlocks;      // here: 1 if it is listed
layout(std430) buffer OpenTiles { uint x, y, z; } openTiles;        // groups of fill.comp; x: 1 + listed tiles
layout(std430) writeonly buffer OpenList { uint list[]; } openList;
layout(std430) buffer Counters { uint counters[]; };  // pixels, new, filled, shaded

layout(push_constant) uniform Constants {
  mat4 sourceWorldToClip;
  float planeTolerance;  // relative to the distance from the eye
  float leastCos;
  float leastWeight;
};

// Returns rgb: irradiance, a: bilinear weight of the texels that show the surface; all zeros outside the source
// image. Differences from one of the texels are averaged, so that uniform light is preserved to the last bit. near:
// the same for the light from nearby surfaces.
vec4 fromSource(vec4 position, vec3 normal, vec3 face, out vec3 near) {
  near = vec3(0.0);
  ivec2 size = imageSize(sourceGbufferDistance);
  Taps taps = tapsAround(sourceWorldToClip, position.xyz, size);
  float tolerance = planeTolerance * position.w;
  vec4 sum = vec4(0.0);
  vec3 origin = vec3(0.0);
  bool found = false;
  for (int i = 0; i < taps.count; ++i) {
    ivec2 q = tapPixel(taps, i), inside = clamp(q, ivec2(0), size - 1);
    bool same = q == inside && sameSurface(position.xyz, face, normal, sourceAt(inside),
                                           imageLoad(sourceGbufferNormal, inside).xyz, tolerance, leastCos);
    if (!same) continue;
    vec3 value = imageLoad(sourceIrradiance, inside).rgb;
    if (!found) origin = value;
    found = true;
    float w = tapWeight(taps, i);
    sum += w * vec4(value - origin, 1.0);
#if NEAR_FIELD
    near += w * imageLoad(sourceNearField, inside).rgb;
#endif
  }
  near /= max(sum.a, 1e-12);
  return vec4(origin + sum.rgb / max(sum.a, 1e-12), sum.a);
}

void main() {
  ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, kRows), size = imageSize(irradiance);
  bool open = false;
  uint surfaces = 0u, withoutSource = 0u;
  for (int k = 0; k < kRows; ++k) {
    ivec2 p = first + ivec2(0, k), inside = min(p, size - 1);
    vec4 position = surfaceAt(inside);
    vec3 normal = imageLoad(gbufferNormal, inside).xyz, face = octDecode(imageLoad(gbufferFace, inside).xy);
    bool surface = p == inside && position.w > 0.0, known = false;
    vec4 light = vec4(0.0);
    vec3 near = vec3(0.0);
    if (surface) {
      light = fromSource(position, normal, face, near);
      known = light.a >= leastWeight;
    }
    open = open || (surface && !known);
    surfaces += subgroupBallotBitCount(subgroupBallot(surface));
    withoutSource += subgroupBallotBitCount(subgroupBallot(surface && !known));
    if (p == inside) imageStore(irradiance, p, known ? vec4(light.rgb, 1.0) : vec4(0.0));
#if NEAR_FIELD
    if (p == inside) imageStore(nearField, p, known ? vec4(near, 1.0) : vec4(0.0));
#endif
  }
  if (open) {
    uint tile = uint(first.y / kTile * ((size.x + kTile - 1) / kTile) + first.x / kTile);
    if (atomicOr(tileBlocks.count[tile], 1u) == 0u) openList.list[atomicAdd(openTiles.x, 1u) - 1u] = tile;
  }
  if (subgroupElect() && surfaces > 0u) atomicAdd(counters[0], surfaces);
  if (subgroupElect() && withoutSource > 0u) atomicAdd(counters[1], withoutSource);
}
