#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_ballot : require
// From subsets to all VPLs: the geometry-aware filter of interleaved sampling, on the irradiance only, and the composition
// with reflectance and direct light. Defines: INTERLEAVE, HAS_DIRECT.
//
// A window of (INTERLEAVE + 1)^2 pixels, the outermost with half weight, holds every subset with the total weight 1. The
// filter averages per subset first, then over subsets: each subset counts the same however many of its pixels lie on the
// surface, so nothing darkens and no pattern shows at edges. A subset that the surface has no pixel of is looked for in a
// window three times as wide; what is still missing there is replaced by the mean of the others.

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D gbufferPosition;
layout(set = 0, binding = 1) uniform texture2D gbufferNormal;
layout(set = 0, binding = 2) uniform texture2D gbufferAlbedo;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D partial;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D irradiance;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D indirect;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D radiance;
layout(set = 0, binding = 7, std430) buffer Counters { uint counters[]; };  // pixels, incomplete
#if HAS_DIRECT
layout(set = 0, binding = 8) uniform texture2D direct;
#endif

layout(push_constant) uniform Constants {
  float filterPlane;  // distance from the tangent plane, in parts of the distance to the eye, at which a weight is 1 / e
  float filterCos;    // cosine of the angle between normals at which a weight is 0
};

const float kEnough = 0.2;      // weight below which a subset counts as missing in the small window
const float kAnything = 0.02;   // and in the large one

ivec2 size;
vec3 centre, centreNormal;
float invPlane2;

// rgb: weighted value, a: weight, of one pixel.
vec4 tap(ivec2 q) {
  if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, size))) return vec4(0.0);
  vec4 position = texelFetch(gbufferPosition, q, 0);
  float plane = dot(position.xyz - centre, centreNormal);
  float facing = dot(texelFetch(gbufferNormal, q, 0).xyz, centreNormal);
  float w = exp(-plane * plane * invPlane2) * clamp((facing - filterCos) / (1.0 - filterCos), 0.0, 1.0);
  w = position.w > 0.0 ? w : 0.0;
  return w > 0.0 ? vec4(imageLoad(partial, q).rgb * w, w) : vec4(0.0);
}

// Offset of the pixel of a subset nearest to the centre, along one axis; at INTERLEAVE / 2 there are two.
int nearOffset(int a) { return a < INTERLEAVE / 2 ? a : a - INTERLEAVE; }

vec4 smallWindow(ivec2 p, int ax, int ay) {
  int x = nearOffset(ax), y = nearOffset(ay);
  vec4 sum = tap(p + ivec2(x, y));
  bool twoX = 2 * ax == INTERLEAVE, twoY = 2 * ay == INTERLEAVE;
  if (twoX) sum += tap(p + ivec2(-x, y));
  if (twoY) sum += tap(p + ivec2(x, -y));
  if (twoX && twoY) sum += tap(p + ivec2(-x, -y));
  return sum;
}

vec4 largeWindow(ivec2 p, int ax, int ay) {
  vec4 sum = vec4(0.0);
  for (int j = -2; j < 2; ++j)
    for (int i = -2; i < 2; ++i) sum += tap(p + ivec2(ax, ay) + INTERLEAVE * ivec2(i, j));
  return sum;
}

vec3 gather(ivec2 p, out bool incomplete) {
  vec3 sum = vec3(0.0);
  int missing = 0;
  for (int ay = 0; ay < INTERLEAVE; ++ay) {
    for (int ax = 0; ax < INTERLEAVE; ++ax) {
      vec4 v = smallWindow(p, ax, ay);
      if (v.a < kEnough) ++missing;
      sum += v.rgb / max(v.a, 1e-6);
    }
  }
  incomplete = false;
  if (missing == 0) return sum / float(INTERLEAVE * INTERLEAVE);
  vec4 all = vec4(0.0);
  for (int ay = 0; ay < INTERLEAVE; ++ay) {
    for (int ax = 0; ax < INTERLEAVE; ++ax) {
      vec4 v = smallWindow(p, ax, ay);
      if (v.a < kEnough) v = largeWindow(p, ax, ay);
      if (v.a >= kAnything) all += vec4(v.rgb / v.a, 1.0);
    }
  }
  incomplete = 2.0 * all.a < float(INTERLEAVE * INTERLEAVE);
  return all.rgb / all.a;  // the centre itself is always there
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  size = textureSize(gbufferPosition, 0);
  bool inside = all(lessThan(p, size));
  vec4 position = inside ? texelFetch(gbufferPosition, p, 0) : vec4(0.0);
  bool surface = position.w > 0.0, incomplete = false;
  vec3 e = vec3(0.0);
  if (surface) {
    centre = position.xyz;
    centreNormal = texelFetch(gbufferNormal, p, 0).xyz;
    float scale = filterPlane * position.w;
    invPlane2 = 1.0 / max(scale * scale, 1e-20);
#if INTERLEAVE > 1
    e = gather(p, incomplete);
#else
    e = imageLoad(partial, p).rgb;
#endif
  }
  uvec4 surfaces = subgroupBallot(surface), incompletes = subgroupBallot(incomplete);
  if (subgroupElect()) {
    atomicAdd(counters[0], subgroupBallotBitCount(surfaces));
    if (subgroupBallotBitCount(incompletes) > 0u) atomicAdd(counters[1], subgroupBallotBitCount(incompletes));
  }
  if (!inside) return;
  vec3 reflected = surface ? texelFetch(gbufferAlbedo, p, 0).rgb * e : vec3(0.0);
  vec3 total = reflected;
#if HAS_DIRECT
  total += texelFetch(direct, p, 0).rgb;
#endif
  imageStore(irradiance, p, vec4(e, 1.0));
  imageStore(indirect, p, vec4(reflected, 1.0));
  imageStore(radiance, p, vec4(min(total, 65504.0), 1.0));
}
