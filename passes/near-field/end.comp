// The mean length of rays over this frame and those before.
#include "device/sums.glsl"
#include "records/near_field.h"
#include "scene/scene.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer StateBlock { NearFieldState value; } state;

void main() {
  float hits = sumOf(state.value.hits, state.value.hitsHigh);
  if (!(hits > 0.0)) return;
  float now = diagonal() * sumOf(state.value.diagonals, state.value.diagonalsHigh) / hits;
  state.value.meanLength = state.value.meanLength > 0.0 ? mix(now, state.value.meanLength, kLengthKept) : now;
}
