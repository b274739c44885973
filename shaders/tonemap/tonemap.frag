// T(x) = sRGB(clamp01(exposure * x)), with the transfer function of IEC 61966-2-1.

uniform texture2D radiance;
layout(location = 0) out vec4 image;
layout(std430) buffer Counters { uint value[]; } counters;

layout(push_constant) uniform Constants { float exposure; };

vec3 srgb(vec3 x) { return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308))); }

void main() {
  vec3 x = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
  // Tests the bits, since compilers may assume that floats are never NaN.
  bvec3 special = equal(floatBitsToUint(x) & 0x7f800000u, uvec3(0x7f800000u));
  if (any(special)) {
    atomicAdd(counters.value[0], 1u);
    if (any(bvec3(uvec3(special) * (floatBitsToUint(x) & 0x007fffffu)))) x = vec3(0.0);
  }
  x = clamp(x * exposure, 0.0, 1e30);
#if REINHARD
  x /= 1.0 + dot(x, vec3(0.2126, 0.7152, 0.0722));
#endif
  image = vec4(srgb(min(x, 1.0)), 1.0);
}
