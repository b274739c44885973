// One level of the mips from the level below.
#include "mipmap/combine.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(rgba16f) uniform readonly image3D sourceColor;
layout(rgba16f) uniform image3D targetColor;
#if WEIGHTED
layout(r16f) uniform readonly image3D sourceWeight;
layout(r16f) uniform writeonly image3D targetWeight;
#endif

#if KEEPS
#include "mipmap/dirty.glsl"
#endif

layout(push_constant) uniform Constants {
  int size;       // cells per side of the target's face
#if KEEPS
  uint firstBit;  // of the target's level
#endif
};

Cell load(ivec3 texel) {
  vec4 color = imageLoad(sourceColor, texel);
#if WEIGHTED
  return color.a > 0.0 ? Cell(color, imageLoad(sourceWeight, texel).r) : kEmpty;
#else
  return color.a > 0.0 ? Cell(color, 0.0) : kEmpty;
#endif
}

void combine(ivec3 cell, int face) {
  ivec3 texel = cell + ivec3(face * size, 0, 0);
  Cell sum = kEmpty;
  ivec3 corner = 2 * texel;
  for (int column = 0; column < 4; ++column) {
    int near = nearChild(face, column), far = farChild(face, column);
    sum = add(sum, behind(load(corner + ivec3(near & 1, near >> 1 & 1, near >> 2)),
                          load(corner + ivec3(far & 1, far >> 1 & 1, far >> 2))));
  }
  if (sum.color.a <= 0.0 && imageLoad(targetColor, texel).a <= 0.0) return;  // empty as before
  imageStore(targetColor, texel, stored(0.25 * sum.color));
#if WEIGHTED
  imageStore(targetWeight, texel, stored(vec4(0.25 * sum.weight)));
#endif
}

void main() {
  ivec3 cell = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, ivec3(size)))) return;
  bool anew = true;
#if KEEPS
  anew = isDirty(firstBit, size, cell);
  if (anew) markDirty(firstBit + uint(size * size * size), size / 2, cell / 2);
#endif
  for (int face = 0; anew && face < kFaces; ++face) combine(cell, face);
}
