layout(local_size_x = 64) in;
layout(std430) buffer Total { uint total[]; };
layout(std430) buffer Counters { uint touched; } counters;
layout(push_constant) uniform Constants { uint key; } constants;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(total.length())) return;
  total[i] += constants.key;
  atomicAdd(counters.touched, 1u);
}
