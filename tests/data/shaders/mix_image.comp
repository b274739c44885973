#extension GL_GOOGLE_include_directive : enable
#include "sampling/random.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
uniform utexture2D a;
#ifdef HAS_B
uniform utexture2D b;
#endif
layout(r32ui) uniform writeonly uimage2D value;
layout(push_constant) uniform Constants { uint key; } constants;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(value)))) return;
  uint h = hashCombine(constants.key, texelFetch(a, p, 0).x);
#ifdef HAS_B
  h = hashCombine(h, texelFetch(b, p, 0).x);
#endif
  imageStore(value, p, uvec4(h));
}
