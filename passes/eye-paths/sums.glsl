// A sum over the invocations of a group, in a fixed order.
const uint kGroup = 256u;
layout(local_size_x = 256) in;

shared vec4 parts[kGroup];

vec4 groupSum(vec4 own) {
  uint i = gl_LocalInvocationID.x;
  parts[i] = own;
  barrier();
  for (uint half_ = kGroup / 2u; half_ > 0u; half_ /= 2u) {
    if (i < half_) parts[i] += parts[i + half_];
    barrier();
  }
  return parts[0];
}
