#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Irradiance from one page of VPLs, each pixel from one of INTERLEAVE^2 subsets of them (METHOD Eq. 2 without rho):
//   E = sum over l of I_l cos_s cos_l Vis / d^2,   I_l = rho_l Phi_l / pi
// Defines: INTERLEAVE; PAGE_VPLS, at most 1024; SHADOWED 0/1; TILED 0/1; KERNEL_DISC 0/1; ACCUMULATE 0/1: not the first page.
#include "common/scene.glsl"
#include "common/vpl.glsl"
#include "common/paraboloid.glsl"
#include "common/vpl_shadow.glsl"

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D gbufferPosition;
layout(set = 0, binding = 1) uniform texture2D gbufferNormal;
layout(set = 0, binding = 2, std140) uniform Vpls { Vpl list[PAGE_VPLS]; } vpls;
layout(set = 0, binding = 3, rgba16f) uniform image2D partial;
#if SHADOWED
layout(set = 0, binding = 4) uniform texture2D gbufferFace;
layout(set = 0, binding = 5) uniform utexture2DArray atlas;
#endif

layout(push_constant) uniform Constants {
  float clampDistance;  // m
#if SHADOWED
  uint firstSlot;       // of this page
  float shadowBias;
#endif
};

void main() {
  // All invocations of a work group share a subset, so that they read the same VPLs at the same time: a work group covers
  // every INTERLEAVE-th pixel of a block.
  uvec2 subset2 = gl_WorkGroupID.xy % INTERLEAVE;
  ivec2 p = ivec2((gl_WorkGroupID.xy / INTERLEAVE * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy) * INTERLEAVE + subset2);
  if (any(greaterThanEqual(p, imageSize(partial)))) return;
  vec4 position = texelFetch(gbufferPosition, p, 0);
  if (position.w <= 0.0) return;  // background: never read by the filter
  vec3 normal = texelFetch(gbufferNormal, p, 0).xyz;
#if SHADOWED
  vec3 face = octDecode(texelFetch(gbufferFace, p, 0).xy);
  AtlasLayout maps = atlasLayout(textureSize(atlas, 0));
#endif
  vec3 sum = vec3(0.0);
  for (uint i = subset2.y * INTERLEAVE + subset2.x; i < PAGE_VPLS; i += INTERLEAVE * INTERLEAVE) {
    Vpl vpl = vpls.list[i];
    vec3 toSurface = position.xyz - vpl.positionArea.xyz;
    float d2 = max(dot(toSurface, toSurface), 1e-12);
    float invD = inversesqrt(d2), d = d2 * invD;
    float cosSurface = max(-dot(normal, toSurface) * invD, 0.0);
    float cosLight = max(dot(vpl.normal.xyz, toSurface) * invD, 0.0);
#if KERNEL_DISC
    float kernel = 1.0 / (d2 + vpl.positionArea.w * (1.0 / kPi));
#else
    float nearest = max(d, clampDistance);  // in the denominator only
    float kernel = 1.0 / (nearest * nearest);
#endif
    float weight = cosSurface * cosLight * kernel;
#if SHADOWED
    mat3 frame_ = orthonormalFrame(vpl.normal.xyz);
    vec3 local = toLocal(frame_, toSurface);
    ivec2 texel = paraboloidTexel(paraboloidProject(local, d), maps.size);
#if TILED
    ivec3 at = atlasTexel(firstSlot + i, texel, maps);
#else
    ivec3 at = atlasTexel(firstSlot + i, texel);
#endif
    float stored = uintBitsToFloat(texelFetch(atlas, at, 0).x);
    float limit = vplShadowLimit(local, d, toLocal(frame_, face), texel, maps.size, shadowBias);
    weight = stored >= limit ? weight : 0.0;
#endif
    sum += weight * vpl.intensity.rgb;
  }
  // Units of `irradiance`: E / pi; a subset stands for all of them.
  sum *= float(INTERLEAVE * INTERLEAVE) / kPi;
#if ACCUMULATE
  sum += imageLoad(partial, p).rgb;
#endif
  imageStore(partial, p, vec4(min(sum, 65504.0), 0.0));
}
