#version 460
#extension GL_KHR_shader_subgroup_ballot : require
// The pixels outside the blocks that are shaded: the base, times reflectance, with direct light. The base is 0 in the
// background, and its alpha above 0 on every surface outside those blocks. Defines: HAS_DIRECT.

layout(local_size_x = 64) in;

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
  ivec2 inside = min(p, size - 1);
  bool wanted = p == inside && imageLoad(shadeMask, inside).r <= 0.5;
  vec4 e = imageLoad(base, inside);
  uint surfaces = subgroupBallotBitCount(subgroupBallot(wanted && e.a > 0.0));
  if (subgroupElect() && surfaces > 0u) atomicAdd(counters[0], surfaces);
  if (!wanted) return;
  vec3 reflected = imageLoad(gbufferAlbedo, p).rgb * e.rgb, total = reflected;
#if HAS_DIRECT
  total += imageLoad(direct, p).rgb;
#endif
  imageStore(irradiance, p, vec4(e.rgb, 1.0));
  imageStore(indirect, p, vec4(reflected, 1.0));
  imageStore(radiance, p, vec4(min(total, 65504.0), 1.0));
}
