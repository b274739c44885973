// The listed blocks of BLOCK x BLOCK pixels, with a row of the dispatch for each pixel of a block and a column for
// 256 blocks. Uses bindings 8 and 9. Shading takes the same pixel of 256 blocks in a work group, so that all its
// invocations use the same subset of VPLs; filtering takes vertically adjacent pixels, whose windows overlap.
#ifndef FOVEA_DEFERRED_BLOCKS_GLSL
#define FOVEA_DEFERRED_BLOCKS_GLSL

uniform usamplerBuffer shadeBlocks;
uniform usamplerBuffer shadeDispatch;

const uint kListedPixels = 4u;  // pixels per invocation; work groups have 64 invocations

uvec2 placeInBlock() { return uvec2(gl_WorkGroupID.y % BLOCK, gl_WorkGroupID.y / BLOCK); }

// A pixel of the item-th block; past the end of the list it is `size`, which is outside the image.
ivec2 inListedBlock(uint item, uvec2 place, ivec2 size) {
  if (item >= texelFetch(shadeDispatch, 0).w) return size;
  uint block = texelFetch(shadeBlocks, int(item)).x;
  return ivec2(uvec2(block & 0xffffu, block >> 16u) * BLOCK + place);
}

// The k-th pixel of this invocation.
ivec2 listedPixel(int k, ivec2 size) {
  return inListedBlock((gl_WorkGroupID.x * kListedPixels + k) * 64u + gl_LocalInvocationIndex, placeInBlock(), size);
}

const int kListedColumn = min(BLOCK, int(kListedPixels));       // vertically adjacent pixels, of one block
const int kListedColumns = int(kListedPixels) / kListedColumn;  // columns per invocation

// The first pixel of the k-th column of this invocation.
ivec2 listedColumn(int k, ivec2 size) {
  const uint kInBlock = BLOCK * BLOCK / kListedColumn;
  uint group = (k * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint column = group * 64u + gl_LocalInvocationIndex, place = column % kInBlock;
  return inListedBlock(column / kInBlock, uvec2(place % BLOCK, place / BLOCK * kListedColumn), size);
}

#endif
