// T(x) = sRGB(clamp01(exposure * x)), with the transfer function of IEC 61966-2-1. Defines: REINHARD, AGX; ADAPTED, 1
// to read the exposure that replaces the scene's own.

uniform texture2D radiance;
#if ADAPTED
layout(r32f) uniform readonly image2D adapted;
#endif
layout(location = 0) out vec4 image;
layout(std430) buffer Counters { uint value[]; } counters;

layout(push_constant) uniform Constants {
  float exposure;  // 0 if none is given
  float sceneExposure;  // factor on light as it is stored, as in `adapted`
  float preExposure;
#if AGX
  float contrast, saturation;
#endif
};

vec3 srgb(vec3 x) { return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308))); }

#if AGX
// AgX (Troy Sobotka, github.com/sobotka/AgX) with the matrices, the range and the polynomial of Benjamin Wrensch,
// "Minimal AgX Implementation", 2023: primaries are drawn together, light is encoded as its logarithm over 16.5 stops
// about middle grey, a sigmoid gives the code of a display of exponent 2.2, and the primaries go back. Contrast and
// saturation are applied to the codes, as the looks on the same page are.
vec3 agx(vec3 light) {
  const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,  // columns
                          0.0784335999999992, 0.878468636469772, 0.0784336,
                          0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                           -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                           -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float least = -12.47393, most = 4.026069;  // stops
  vec3 t = clamp((log2(max(inset * light, 1e-10)) - least) / (most - least), 0.0, 1.0);
  vec3 code = (((((15.5 * t - 40.14) * t + 31.96) * t - 6.868) * t + 0.4298) * t + 0.1191) * t - 0.00232;
  code = pow(max(code, 0.0), vec3(contrast));
  code = mix(vec3(dot(code, vec3(0.2126, 0.7152, 0.0722))), code, saturation);
  return pow(clamp(outset * code, 0.0, 1.0), vec3(2.2));
}
#endif

void main() {
  vec3 x = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
  // Tests the bits, since compilers may assume that floats are never NaN.
  bvec3 special = equal(floatBitsToUint(x) & 0x7f800000u, uvec3(0x7f800000u));
  if (any(special)) {
    atomicAdd(counters.value[0], 1u);
    if (any(bvec3(uvec3(special) * (floatBitsToUint(x) & 0x007fffffu)))) x = vec3(0.0);
  }
#if ADAPTED
  float own = imageLoad(adapted, ivec2(0)).r;
#else
  float own = sceneExposure;
#endif
  x = clamp(x * (exposure > 0.0 ? exposure / preExposure : own), 0.0, 1e30);
#if REINHARD
  x /= 1.0 + dot(x, vec3(0.2126, 0.7152, 0.0722));
#endif
#if AGX
  x = agx(x);
#endif
  // Rounded to bytes here, since devices differ in how they round when they write.
  image = vec4(floor(255.0 * srgb(min(x, 1.0)) + 0.5) / 255.0, 1.0);
}
