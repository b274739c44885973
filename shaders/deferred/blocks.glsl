// The listed blocks of BLOCK x BLOCK pixels: a work group takes the same pixel of 256 of them, so that all its invocations
// want the same subset of VPLs; its place in the block is the row of the dispatch. Bindings 8 and 9.
#ifndef FOVEA_DEFERRED_BLOCKS_GLSL
#define FOVEA_DEFERRED_BLOCKS_GLSL

layout(set = 0, binding = 8) uniform usamplerBuffer shadeBlocks;
layout(set = 0, binding = 9) uniform usamplerBuffer shadeDispatch;

const uint kListedPixels = 4u;  // of an invocation; work groups have 64

uvec2 placeInBlock() { return uvec2(gl_WorkGroupID.y % BLOCK, gl_WorkGroupID.y / BLOCK); }

// The k-th pixel of this invocation; past the end of the list: `size`, which is outside the image.
ivec2 listedPixel(int k, ivec2 size) {
  uint item = (gl_WorkGroupID.x * kListedPixels + k) * 64u + gl_LocalInvocationIndex;
  if (item >= texelFetch(shadeDispatch, 0).w) return size;
  uint block = texelFetch(shadeBlocks, int(item)).x;
  return ivec2(uvec2(block & 0xffffu, block >> 16u) * BLOCK + placeInBlock());
}

#endif
