// The mean length of rays over this frame and those before.
#include "device/sums.glsl"
#include "records/near_field.h"
#include "scene/scene.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer StateBlock { NearFieldState value; } state;
layout(std430) readonly buffer SumsBlock { NearFieldSums value; } sums;

void main() {
  float hits = sumOf(sums.value.hits, sums.value.hitsHigh);
  if (!(hits > 0.0)) return;
  float now = diagonal() * sumOf(sums.value.diagonals, sums.value.diagonalsHigh) / hits;
  state.value.meanLength = state.value.meanLength > 0.0 ? mix(now, state.value.meanLength, kLengthKept) : now;
}
