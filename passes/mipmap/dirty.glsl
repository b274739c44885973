// One bit for each cell of level 1 and above, level after level: something below it changed in this frame.
#ifndef FOVEA_MIPMAP_DIRTY_GLSL
#define FOVEA_MIPMAP_DIRTY_GLSL

layout(std430) buffer Dirty { uint bits[]; } dirty;

uint dirtyBit(uint first, int size, ivec3 cell) { return first + uint(cell.x + size * (cell.y + size * cell.z)); }
bool isDirty(uint first, int size, ivec3 cell) {
  uint bit = dirtyBit(first, size, cell);
  return (dirty.bits[bit >> 5u] >> (bit & 31u) & 1u) != 0u;
}
// size: of the level in cells; a level that is not half the size of the one below does not exist.
void markDirty(uint first, int size, ivec3 cell) {
  uint bit = dirtyBit(first, size, cell);
  if (all(lessThan(cell, ivec3(size)))) atomicOr(dirty.bits[bit >> 5u], 1u << (bit & 31u));
}

#endif
