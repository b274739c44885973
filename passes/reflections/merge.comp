// The light that this frame's rays have gathered becomes part of the cells. Define: RAY_PASSAGE as 1.
#include "rays/gather_cache.glsl"

layout(local_size_x = 64) in;

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place < kGatherCells) mergeSamples(place, 0.0);
}
