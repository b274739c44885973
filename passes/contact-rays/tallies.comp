// What is remembered of the rays to each VPL.
#include "records/contact.h"

layout(local_size_x = 64) in;

layout(std430) readonly buffer HistoryBlock { vec2 list[]; } history;
layout(std430) readonly buffer CountsBlock { uvec2 list[]; } counts;
layout(std430) writeonly buffer TalliesBlock { vec2 list[]; } tallies;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(tallies.list.length())) return;
  uvec2 sum = uvec2(0u);
  for (uint list = 0u; list < kTallySums; ++list) sum += counts.list[list * uint(tallies.list.length()) + i];
  tallies.list[i] = kTallyKept * history.list[i] + vec2(sum);
}
