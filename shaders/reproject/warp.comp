#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_ballot : require
// The irradiance of the first eye on what the second eye sees. The point of a pixel is projected into the source image; of
// the four texels around it those count that show the same surface: near the tangent plane of the pixel, normals alike.
// Bilinear between them. A pixel with too little of them has no source, and makes its whole block be shaded.
// Defines: INTERLEAVE, pixels a side of a block.
#include "common/scene.glsl"

const uint kTile = 16u, kBlocksPerSide = kTile / INTERLEAVE;

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0) uniform texture2D gbufferPosition;
layout(set = 0) uniform texture2D gbufferNormal;
layout(set = 0) uniform texture2D gbufferFace;
layout(set = 0) uniform texture2D sourceGbufferPosition;
layout(set = 0) uniform texture2D sourceGbufferNormal;
layout(set = 0) uniform texture2D sourceIrradiance;
layout(set = 0, rgba16f) uniform writeonly image2D irradiance;
layout(set = 0, r8) uniform writeonly image2D shadeMask;
layout(set = 0, std430) writeonly buffer TileBlocks { uint count[]; } tileBlocks;
layout(set = 0, std430) buffer Counters { uint counters[]; };  // pixels, new, shaded

layout(push_constant) uniform Constants {
  mat4 sourceWorldToClip;
  float planeTolerance;  // in parts of the distance to the eye
  float leastCos;
  float leastWeight;
};

shared uint newInBlock[kBlocksPerSide * kBlocksPerSide];
shared uint blocks;

// rgb: irradiance, a: bilinear weight of the texels that show the surface; 0 0 0 0 outside the source image. Differences to
// one of the texels are averaged, so that even light stays what it is to the last bit.
vec4 fromSource(vec4 position, vec3 normal, vec3 face) {
  vec4 clip = sourceWorldToClip * vec4(position.xyz, 1.0);
  if (clip.w <= 0.0) return vec4(0.0);
  ivec2 size = textureSize(sourceGbufferPosition, 0);
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
    vec4 p = texelFetch(sourceGbufferPosition, inside, 0);
    bool same = q == inside && p.w > 0.0 && abs(dot(p.xyz - position.xyz, face)) <= tolerance &&
                dot(texelFetch(sourceGbufferNormal, inside, 0).xyz, normal) >= leastCos;
    if (!same) continue;
    vec3 value = texelFetch(sourceIrradiance, inside, 0).rgb;
    if (!found) origin = value;
    found = true;
    vec2 w = mix(1.0 - f, f, vec2(d));
    sum += w.x * w.y * vec4(value - origin, 1.0);
  }
  return vec4(origin + sum.rgb / max(sum.a, 1e-12), sum.a);
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(irradiance);
  uvec2 local = gl_LocalInvocationID.xy / INTERLEAVE;
  uint block = local.y * kBlocksPerSide + local.x, index = gl_LocalInvocationIndex;
  if (index < newInBlock.length()) newInBlock[index] = 0u;
  if (index == 0u) blocks = 0u;
  barrier();

  bool inImage = all(lessThan(p, size));
  vec4 position = texelFetch(gbufferPosition, min(p, size - 1), 0);
  bool surface = inImage && position.w > 0.0, known = false;
  vec4 warped = vec4(0.0);
  if (surface) {
    warped = fromSource(position, texelFetch(gbufferNormal, p, 0).xyz, octDecode(texelFetch(gbufferFace, p, 0).xy));
    known = warped.a >= leastWeight;
    if (!known) atomicOr(newInBlock[block], 1u);
  }
  barrier();

  bool shade = newInBlock[block] != 0u;
  if (index < newInBlock.length() && newInBlock[index] != 0u) atomicAdd(blocks, 1u);
  barrier();
  if (index == 0u) tileBlocks.count[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = blocks;
  uvec3 counts = uvec3(subgroupBallotBitCount(subgroupBallot(surface)), subgroupBallotBitCount(subgroupBallot(surface && !known)),
                       subgroupBallotBitCount(subgroupBallot(surface && shade)));
  if (subgroupElect())
    for (int i = 0; i < 3; ++i)
      if (counts[i] > 0u) atomicAdd(counters[i], counts[i]);
  if (!inImage) return;
  imageStore(irradiance, p, known ? vec4(warped.rgb, 1.0) : vec4(0.0));
  imageStore(shadeMask, p, vec4(shade ? 1.0 : 0.0));
}
