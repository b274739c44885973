// Paraboloid maps: one hemisphere on a square, as the shadow atlas stores it and the shading passes read it
// (Brabec, Annen and Seidel, "Shadow Mapping for Hemispherical and Omnidirectional Light Sources", CGI 2002).
//
// Seen from a VPL with unit normal n, a unit direction d with local coordinates (x, y, z), z along n, lies at
//   p = (x, y) / (1 + z)      (stereographic projection; the rim |p| = 1 is the horizon plane z = 0)
// and at uv = p / 2 + 1/2. Texels whose centre has |p| >= 1 look behind the plane: nothing is stored there (inf).
#ifndef FOVEA_PARABOLOID_GLSL
#define FOVEA_PARABOLOID_GLSL

#include "records/paraboloid.h"

// A frame around a unit normal; its columns are tangent, bitangent and normal (unit, right-handed). Branchless and
// without singularities: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
mat3 orthonormalFrame(vec3 n) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z);
  float b = n.x * n.y * a;
  return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Converts a world-space vector to the frame's coordinates and back.
vec3 toLocal(mat3 frame, vec3 v) { return v * frame; }
vec3 toWorld(mat3 frame, vec3 v) { return frame * v; }

// Projects a local vector of the length `len` > 0, z > -len, to the plane of the map; |p| <= 1 for the hemisphere.
vec2 paraboloidProject(vec3 local, float len) { return vec2(local) * (1.0 / (len + local.z)); }

// Converts a point of the map's plane to the local unit direction.
vec3 paraboloidDirection(vec2 p) {
  float q = dot(p, p);
  return vec3(2.0 * p, 1.0 - q) / (1.0 + q);
}

// Conversions between the plane of the map, uv in [0, 1]^2 and texels of a map with `size` texels per side.
vec2 paraboloidUv(vec2 p) { return 0.5 * p + 0.5; }
vec2 paraboloidTexelCentre(ivec2 texel, int size) { return (2.0 * vec2(texel) + 1.0) / float(size) - 1.0; }
ivec2 paraboloidTexel(vec2 p, int size) {
  return clamp(ivec2(floor(paraboloidUv(p) * float(size))), ivec2(0), ivec2(size - 1));
}
// Local unit direction through a texel's centre; if z <= 0, the texel is unused.
vec3 paraboloidTexelDirection(ivec2 texel, int size) {
  return paraboloidDirection(paraboloidTexelCentre(texel, size));
}

// The layout of a shadow atlas, and the texel of the atlas at which a texel of the map of a slot lies.
AtlasLayout atlasLayout(ivec3 imageSizes) {  // textureSize(atlas, 0) or imageSize(atlas)
  return AtlasLayout(imageSizes.y, findMSB(imageSizes.x / imageSizes.y));
}
ivec3 atlasTexel(uint slot, ivec2 texel, AtlasLayout layout_) {
  int map = int(slot) & ((1 << layout_.shift) - 1);
  return ivec3(texel.x + map * layout_.size, texel.y, int(slot) >> layout_.shift);
}
// For layout `layers` only, where it saves the arithmetic.
ivec3 atlasTexel(uint slot, ivec2 texel) { return ivec3(texel, int(slot)); }

#endif
