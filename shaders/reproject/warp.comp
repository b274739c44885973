#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_ballot : require
// The irradiance of the first eye on what the second eye sees. The point of a pixel is projected into the source image; of
// the four texels around it those count that show the same surface: near the tangent plane of the pixel, normals alike.
// Bilinear between them. A pixel with too little of them has no source. It takes the light of pixels of its surface at most
// FILL pixels away, in its tile, that have one: nearer than the interleaved samples that shading would gather. Where there
// are none it makes its whole block be shaded.
// Defines: INTERLEAVE, pixels a side of a block; FILL, 0: no such pixels.
#include "common/scene.glsl"

const uint kTile = 16u, kBlocksPerSide = kTile / INTERLEAVE;

layout(local_size_x = 16, local_size_y = 16) in;

// Images and not textures: on a CPU device a load from a texture costs several times as much.
layout(set = 0, rgba32f) uniform readonly image2D gbufferPosition;
layout(set = 0, rgba16f) uniform readonly image2D gbufferNormal;
layout(set = 0) uniform texture2D gbufferFace;
layout(set = 0, rgba32f) uniform readonly image2D sourceGbufferPosition;
layout(set = 0, rgba16f) uniform readonly image2D sourceGbufferNormal;
layout(set = 0, rgba16f) uniform readonly image2D sourceIrradiance;
layout(set = 0, rgba16f) uniform writeonly image2D irradiance;
layout(set = 0, r8) uniform writeonly image2D shadeMask;
layout(set = 0, std430) writeonly buffer TileBlocks { uint count[]; } tileBlocks;
layout(set = 0, std430) buffer Counters { uint counters[]; };  // pixels, new, filled, shaded

layout(push_constant) uniform Constants {
  mat4 sourceWorldToClip;
  float planeTolerance;  // in parts of the distance to the eye
  float leastCos;
  float leastWeight;
};

shared uint newInBlock[kBlocksPerSide * kBlocksPerSide];
shared uint blocks;
#if FILL
shared vec4 tile[kTile * kTile];  // rgb: irradiance, a: 1 where it has a source
#endif

// rgb: irradiance, a: bilinear weight of the texels that show the surface; 0 0 0 0 outside the source image. Differences to
// one of the texels are averaged, so that even light stays what it is to the last bit.
vec4 fromSource(vec4 position, vec3 normal, vec3 face) {
  vec4 clip = sourceWorldToClip * vec4(position.xyz, 1.0);
  if (clip.w <= 0.0) return vec4(0.0);
  ivec2 size = imageSize(sourceGbufferPosition);
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(size) - 0.5;  // texel centres at whole numbers
  if (any(lessThanEqual(at, vec2(-1.0))) || any(greaterThanEqual(at, vec2(size)))) return vec4(0.0);
  ivec2 first = ivec2(floor(at));
  vec2 f = at - floor(at);
  float tolerance = planeTolerance * position.w;
  vec4 sum = vec4(0.0);
  vec3 origin = vec3(0.0);
  bool found = false;
  for (int i = 0; i < 4; ++i) {
    ivec2 d = ivec2(i & 1, i >> 1), q = first + d, inside = clamp(q, ivec2(0), size - 1);
    vec4 p = imageLoad(sourceGbufferPosition, inside);
    bool same = q == inside && p.w > 0.0 && abs(dot(p.xyz - position.xyz, face)) <= tolerance &&
                dot(imageLoad(sourceGbufferNormal, inside).xyz, normal) >= leastCos;
    if (!same) continue;
    vec3 value = imageLoad(sourceIrradiance, inside).rgb;
    if (!found) origin = value;
    found = true;
    vec2 w = mix(1.0 - f, f, vec2(d));
    sum += w.x * w.y * vec4(value - origin, 1.0);
  }
  return vec4(origin + sum.rgb / max(sum.a, 1e-12), sum.a);
}

#if FILL
// Mean over the pixels of the surface around, nearer ones with more weight; a: 0 without one.
vec4 fromNeighbours(ivec2 p, vec4 position, vec3 normal, vec3 face, bool wanted) {
  vec4 sum = vec4(0.0);
  vec3 origin = vec3(0.0);
  float tolerance = planeTolerance * position.w;
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  const int kSide = 2 * FILL + 1;
  int turns = wanted ? kSide * kSide : 0;  // a loop of no turns is skipped where a branch is not, on a CPU device
  for (int i = 0; i < turns; ++i) {
    ivec2 d = ivec2(i % kSide, i / kSide) - FILL, q = local + d;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, ivec2(kTile)))) continue;
    vec4 value = tile[q.y * int(kTile) + q.x];
    if (value.a == 0.0) continue;
    bool same = abs(dot(imageLoad(gbufferPosition, p + d).xyz - position.xyz, face)) <= tolerance &&
                dot(imageLoad(gbufferNormal, p + d).xyz, normal) >= leastCos;
    if (!same) continue;
    if (sum.a == 0.0) origin = value.rgb;
    float w = 1.0 / float(d.x * d.x + d.y * d.y);
    sum += w * vec4(value.rgb - origin, 1.0);
  }
  return vec4(origin + sum.rgb / max(sum.a, 1e-12), sum.a);
}
#endif

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(irradiance);
  uvec2 local = gl_LocalInvocationID.xy / INTERLEAVE;
  uint block = local.y * kBlocksPerSide + local.x, index = gl_LocalInvocationIndex;
  if (index < newInBlock.length()) newInBlock[index] = 0u;
  if (index == 0u) blocks = 0u;
  barrier();

  bool inImage = all(lessThan(p, size));
  vec4 position = imageLoad(gbufferPosition, min(p, size - 1));
  vec3 normal = imageLoad(gbufferNormal, min(p, size - 1)).xyz, face = octDecode(texelFetch(gbufferFace, min(p, size - 1), 0).xy);
  bool surface = inImage && position.w > 0.0, known = false, filled = false;
  vec4 light = vec4(0.0);
  if (surface) {
    light = fromSource(position, normal, face);
    known = light.a >= leastWeight;
  }
  light = known ? vec4(light.rgb, 1.0) : vec4(0.0);
#if FILL
  tile[index] = light;
  barrier();
  vec4 around = fromNeighbours(p, position, normal, face, surface && !known);
  filled = around.a > 0.0;
  if (filled) light = vec4(around.rgb, 0.5);
#endif
  if (surface && !known && !filled) atomicOr(newInBlock[block], 1u);
  barrier();

  bool shade = newInBlock[block] != 0u;
  if (index < newInBlock.length() && newInBlock[index] != 0u) atomicAdd(blocks, 1u);
  barrier();
  if (index == 0u) tileBlocks.count[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = blocks;
  uvec4 counts = uvec4(subgroupBallotBitCount(subgroupBallot(surface)), subgroupBallotBitCount(subgroupBallot(surface && !known)),
                       subgroupBallotBitCount(subgroupBallot(filled)), subgroupBallotBitCount(subgroupBallot(surface && shade)));
  if (subgroupElect())
    for (int i = 0; i < 4; ++i)
      if (counts[i] > 0u) atomicAdd(counters[i], counts[i]);
  if (!inImage) return;
  imageStore(irradiance, p, light);
  imageStore(shadeMask, p, vec4(shade ? 1.0 : 0.0));
}
