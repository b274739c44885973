// Handles a cell that a triangle overlaps: without ACCUMULATE it is marked, with it the piece of the triangle is
// added to the voxel's sums.
#include "materials/passage.glsl"
#include "scene/objects.glsl"
#include "voxels/voxel.glsl"
#include "voxelize/state.glsl"
#include "voxelize/triangle.glsl"

#if ACCUMULATE
layout(std430) readonly buffer StateBlock { State value; } state;
layout(r32ui) uniform readonly uimage3D voxelsIndex;
layout(std430) buffer SumsBlock { uint words[]; } sums;
#else
layout(std430) buffer MarksBlock { uint words[]; } marks;
#endif

layout(push_constant) uniform Constants {
  uint resolution;
  uint firstTriangle, triangleCount;
#if ACCUMULATE
  uint phase;
  uint base;   // first voxel of the batch that `sums` has room for, within the phase
  uint batch;  // voxels
#endif
} constants;

// Sums are 64-bit multiples of 2^-32 in two words (not every device has 64-bit atomics).
float fixedPoint(float x) {
  precise float y = floor(x * 4294967296.0 + 0.5);
  return y;
}

#if ACCUMULATE
void addTo(uint word, float x) {
  precise float y = fixedPoint(x);
  precise float high = floor(y * (1.0 / 4294967296.0));
  precise float low = y - high * 4294967296.0;
  uint h = uint(high), l = uint(low);
  if (l != 0u) {
    uint old = atomicAdd(sums.words[word], l);
    if (old + l < l) h += 1u;
  }
  if (h != 0u) atomicAdd(sums.words[word + 1u], h);
}

void addTo(uint word, precise vec3 x) {
  addTo(word, x.x);
  addTo(word + 2u, x.y);
  addTo(word + 4u, x.z);
}

// Words of a side: area, reflectance and emission (times the area), weight, position and normal + 1 (times the weight),
// object, triangle. `triangle` counts from the first non-static one; all kTriangleBits are set if the object does not
// deform.
void addPiece(uint side, Piece piece, vec3 normal, SurfacePoint surface, uint object, uint triangle) {
  uint word = side * kSumWords;
  bool emissive = surface.emission != vec3(0.0);
  precise vec3 reflectance = piece.area * surface.reflectance;
  precise vec3 emission = piece.area * min(surface.emission, vec3(65504.0));
  precise float weight = piece.area * (emissive ? kEmissiveWeight : 1.0);
  precise vec3 position = weight * piece.centre;
  precise vec3 biased = weight * (normal + 1.0);
  addTo(word, piece.area);
  addTo(word + 2u, reflectance);
  if (emissive) addTo(word + 8u, emission);
  addTo(word + 14u, weight);
  addTo(word + 16u, position);
  addTo(word + 22u, biased);
  // The object of the largest piece; of several such pieces, the smallest number.
  atomicMax(sums.words[word + 28u], uint(min(piece.area * 32768.0, 65535.0)) << 16 | (0xffffu - object));
  // The same for the triangle, with coarser areas.
  const uint kNone = (1u << kTriangleBits) - 1u;
  if (triangle < kNone)
    atomicMax(sums.words[word + 29u],
              uint(min(piece.area * 512.0, 1023.0)) << kTriangleBits | (kNone - triangle));
}
#endif

void visitCell(CellTriangle t, uint triangle, uvec4 indices, Material material, ivec3 turned) {
  vec3 place = vec3(turned);
  precise vec3 a = t.a - place;
  precise vec3 b = t.b - place;
  precise vec3 c = t.c - place;
  if (!overlapsCell(t, a, b, c)) return;
  uvec3 cell = uvec3(turnBack(place, t.axis));
#if !ACCUMULATE
  uint linear = cell.x + constants.resolution * (cell.y + constants.resolution * cell.z), bit = 1u << (linear % 32u);
  if ((marks.words[linear / 32u] & bit) != 0u) return;  // a race with another invocation that sets it only costs time
#else
  uint voxel = imageLoad(voxelsIndex, ivec3(cell)).r - 1u - state.value.phases[constants.phase].first - constants.base;
  // Not in this batch: too large, or below 0 and wrapped around.
  if (voxel >= constants.batch) return;
#endif
  Piece piece;
  if (!crossesCell(t, a, b, c, piece)) piece = clipToCell(t, a, b, c);
  if (fixedPoint(piece.area) < 1.0) return;
  vec2 weights = cellWeights(t, a, piece.centre);
  float s = weights.x, r = weights.y;
  precise vec2 uv = sceneUv(indices.x) * (1.0 - s - r) + sceneUv(indices.y) * s + sceneUv(indices.z) * r;
  bool present = true;
  if (material.alphaCutoff != 0.0) {
    float alpha = sceneAlpha(indices.x) * (1.0 - s - r) + sceneAlpha(indices.y) * s + sceneAlpha(indices.z) * r;
    present = stops(materialOf(indices), uv, alpha, kMeanCosine, kEitherWay);
  }
  if (!present) return;
#if ACCUMULATE
  SurfacePoint surface = surfaceAt(materialOf(indices), uv);
  piece.centre = turnBack(piece.centre, t.axis);
  uint side = 2u * voxel + voxelSideOf(t.normal);
  uint moving = objectDeforms(objectOf(indices)) ? triangle - frame.firstMovingTriangle : ~0u;
  addPiece(side, piece, t.normal, surface, objectOf(indices), moving);
  if (material.doubleSided) addPiece(side ^ 1u, piece, -t.normal, surface, objectOf(indices), moving);
#else
  atomicOr(marks.words[linear / 32u], bit);
#endif
}

void visitColumn(CellTriangle t, uint triangle, uvec4 indices, Material material, uint column) {
  ivec2 xy = columnAt(t, column);
  ivec2 range = columnRange(t, xy);
  for (int z = range.x; z <= range.y; ++z) visitCell(t, triangle, indices, material, ivec3(xy, z));
}
