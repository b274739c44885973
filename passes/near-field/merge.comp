// The light that this frame's rays have gathered becomes part of the cells. Define: RAY_PASSAGE 0/1.
#include "rays/gather_cache.glsl"
#include "records/near_field.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer StateBlock { NearFieldState value; } state;

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place < kGatherCells) mergeSamples(place, state.value.ageing);
}
