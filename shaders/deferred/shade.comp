#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Irradiance from one page of VPLs, each pixel from one of INTERLEAVE^2 subsets of them (METHOD Eq. 2 without rho):
//   E = sum over l of I_l cos_s cos_l Vis / d^2,   I_l = rho_l Phi_l / pi
// Defines: INTERLEAVE; PAGE_VPLS, at most 1024; SHADOWED 0/1; TILED 0/1; KERNEL_DISC 0/1; ACCUMULATE 0/1: not the first page;
// MASKED 0/1: only the listed blocks of BLOCK x BLOCK pixels.
#include "common/scene.glsl"
#include "common/vpl.glsl"
#include "common/paraboloid.glsl"
#include "common/vpl_shadow.glsl"

// An invocation shades kPixels pixels below each other: a VPL and its frame are loaded once for all of them, and neighbours
// read the same lines of a map. On a CPU, where loads from uniform buffers cost as much as the rest, this is worth a factor
// of two.
#if MASKED
#include "deferred/blocks.glsl"
const int kPixels = int(kListedPixels);
layout(local_size_x = 16, local_size_y = 4) in;
#else
const int kPixels = 8;
layout(local_size_x = 16, local_size_y = 2) in;
#endif

layout(set = 0, binding = 0, rgba32f) uniform readonly image2D gbufferPosition;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D gbufferNormal;
layout(set = 0, binding = 2, std140) uniform Vpls { Vpl list[PAGE_VPLS]; } vpls;
layout(set = 0, binding = 3, rgba16f) uniform image2D partial;
#if SHADOWED
layout(set = 0, binding = 4) uniform texture2D gbufferFace;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2DArray atlas;
#endif

layout(push_constant) uniform Constants {
  float clampDistance;  // m
#if SHADOWED
  uint firstSlot;       // of this page
  float shadowBias;
#endif
};

struct Receiver {
  vec3 position, normal, face, sum;
};

// cos_s cos_l kernel, from the lengths along both normals. One division.
float vplWeight(float alongReceiver, float alongNormal, float d2, float d, float area, float clampAt) {
#if KERNEL_DISC
  float denominator = d2 * (d2 + area * (1.0 / kPi));
#else
  float nearest = max(d, clampAt);  // in the denominator only
  float denominator = d2 * (nearest * nearest);
#endif
  return max(-alongReceiver, 0.0) * max(alongNormal, 0.0) / denominator;
}

// All invocations of a work group share a subset, so that they read the same VPLs at the same time.
#if MASKED
uvec2 subsetOfGroup() { return placeInBlock() % INTERLEAVE; }
ivec2 pixelAt(int k, ivec2 size) { return listedPixel(k, size); }
#else
// A work group covers every INTERLEAVE-th pixel of a block. The subset is the slowest of the three dimensions: all that is
// shaded at a time reads the same few maps.
uvec2 subsetOfGroup() { return uvec2(gl_WorkGroupID.z % INTERLEAVE, gl_WorkGroupID.z / INTERLEAVE); }
ivec2 pixelAt(int k, ivec2 size) {
  uvec2 block = gl_WorkGroupID.xy * (gl_WorkGroupSize.xy * uvec2(1, kPixels));
  uvec2 place = block + gl_LocalInvocationID.xy * uvec2(1, kPixels) + uvec2(0, k);
  return ivec2(place * INTERLEAVE + subsetOfGroup());
}
#endif

void main() {
  uvec2 subset2 = subsetOfGroup();
  ivec2 size = imageSize(partial);
  Receiver receivers[kPixels];
  bool any_ = false;
  for (int k = 0; k < kPixels; ++k) {
    ivec2 p = min(pixelAt(k, size), size - 1);
    vec4 position = imageLoad(gbufferPosition, p);
    receivers[k].position = position.xyz;
    receivers[k].normal = imageLoad(gbufferNormal, p).xyz;
#if SHADOWED
    receivers[k].face = octDecode(texelFetch(gbufferFace, p, 0).xy);
#endif
    receivers[k].sum = vec3(0.0);
    any_ = any_ || position.w > 0.0;
  }
  if (!any_) return;  // all background: never read by the filter
  float clampAt = clampDistance;
#if SHADOWED
  AtlasLayout maps = atlasLayout(imageSize(atlas));
  uint first = firstSlot;
  float bias = shadowBias;
#endif
  for (uint i = subset2.y * INTERLEAVE + subset2.x; i < PAGE_VPLS; i += INTERLEAVE * INTERLEAVE) {
    Vpl vpl = vpls.list[i];
#if SHADOWED
    mat3 frame_ = orthonormalFrame(vpl.normal.xyz);
#endif
    for (int k = 0; k < kPixels; ++k) {
      vec3 toSurface = receivers[k].position - vpl.positionArea.xyz;
      float d2 = max(dot(toSurface, toSurface), 1e-12), d = sqrt(d2);
      float alongNormal = dot(vpl.normal.xyz, toSurface);
      float weight = vplWeight(dot(receivers[k].normal, toSurface), alongNormal, d2, d, vpl.positionArea.w, clampAt);
#if SHADOWED
      vec3 local = vec3(dot(frame_[0], toSurface), dot(frame_[1], toSurface), alongNormal);
      ivec2 texel = paraboloidTexel(paraboloidProject(local, d), maps.size);
#if TILED
      ivec3 at = atlasTexel(first + i, texel, maps);
#else
      ivec3 at = atlasTexel(first + i, texel);
#endif
      float stored = uintBitsToFloat(imageLoad(atlas, at).x);
      float limit = vplShadowLimit(local, d, toLocal(frame_, receivers[k].face), texel, maps.size, bias);
      weight = stored >= limit ? weight : 0.0;
#endif
      receivers[k].sum += weight * vpl.intensity.rgb;
    }
  }
  for (int k = 0; k < kPixels; ++k) {
    ivec2 p = pixelAt(k, size);
    if (any(greaterThanEqual(p, size))) continue;
    // Units of `irradiance`: E / pi; a subset stands for all of them.
    vec3 sum = receivers[k].sum * (float(INTERLEAVE * INTERLEAVE) / kPi);
#if ACCUMULATE
    sum += imageLoad(partial, p).rgb;
#endif
    imageStore(partial, p, vec4(min(sum, 65504.0), 0.0));
  }
}
