// What is remembered of the rays to each VPL.
layout(local_size_x = 64) in;

layout(std430) readonly buffer HistoryBlock { vec2 list[]; } history;
layout(std430) readonly buffer CountsBlock { uvec2 list[]; } counts;
layout(std430) writeonly buffer TalliesBlock { vec2 list[]; } tallies;

const float kKept = 0.75;  // share of the tallies that is kept from frame to frame

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(tallies.list.length())) return;
  tallies.list[i] = kKept * history.list[i] + vec2(counts.list[i]);
}
