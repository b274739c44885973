#version 460
#extension GL_KHR_shader_subgroup_ballot : require
// The pixels outside the blocks that are shaded: the base, times reflectance, with direct light. Defines: HAS_DIRECT.

layout(local_size_x = 64) in;

layout(set = 0, rgba32f) uniform readonly image2D gbufferPosition;
layout(set = 0, rgba16f) uniform readonly image2D gbufferAlbedo;
layout(set = 0, rgba16f) uniform readonly image2D base;
layout(set = 0, r8) uniform readonly image2D shadeMask;
layout(set = 0, rgba16f) uniform writeonly image2D irradiance;
layout(set = 0, rgba16f) uniform writeonly image2D indirect;
layout(set = 0, rgba16f) uniform writeonly image2D radiance;
layout(set = 0, std430) buffer Counters { uint counters[]; };  // pixels, incomplete, -, shaded
#if HAS_DIRECT
layout(set = 0, rgba16f) uniform readonly image2D direct;
#endif

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(irradiance);
  bool inImage = all(lessThan(p, size));
  bool surface = inImage && imageLoad(gbufferPosition, min(p, size - 1)).w > 0.0;
  uint surfaces = subgroupBallotBitCount(subgroupBallot(surface));
  if (subgroupElect() && surfaces > 0u) atomicAdd(counters[0], surfaces);
  if (!inImage || imageLoad(shadeMask, p).r > 0.5) return;
  vec3 e = surface ? imageLoad(base, p).rgb : vec3(0.0);
  vec3 reflected = imageLoad(gbufferAlbedo, p).rgb * e, total = reflected;
  if (!surface) total = reflected = vec3(0.0);
#if HAS_DIRECT
  total += imageLoad(direct, p).rgb;
#endif
  imageStore(irradiance, p, vec4(e, 1.0));
  imageStore(indirect, p, vec4(reflected, 1.0));
  imageStore(radiance, p, vec4(min(total, 65504.0), 1.0));
}
