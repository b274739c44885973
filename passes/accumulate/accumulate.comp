// mean_n = mean_(n-1) + (x_n - mean_(n-1)) / n. The count is kept in alpha, which the graph zeroes on a reset
// together with the mean, so the two always match.

layout(local_size_x = 8, local_size_y = 8) in;

uniform texture2D value;
layout(rgba32f) uniform image2D mean;
layout(std430) buffer Counters { uint value[]; } counters;

layout(push_constant) uniform Constants { float alpha; };

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(mean)))) return;
  vec3 x = texelFetch(value, p, 0).rgb;
  // Tests the bits, since compilers may assume that floats are never NaN. A single such value would stay in
  // the mean for ever.
  if (any(equal(floatBitsToUint(x) & 0x7f800000u, uvec3(0x7f800000u)))) {
    atomicAdd(counters.value[0], 1u);
    return;
  }
  vec4 old = imageLoad(mean, p);
  float count = old.a + 1.0;
  imageStore(mean, p, vec4(old.rgb + (x - old.rgb) * max(1.0 / count, alpha), count));
}
