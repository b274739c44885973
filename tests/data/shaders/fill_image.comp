layout(local_size_x = 8, local_size_y = 8) in;
layout(r32ui) uniform writeonly uimage2D value;
layout(push_constant) uniform Constants { uint key; uint frameIndex; } constants;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(p, imageSize(value)))) imageStore(value, p, uvec4(constants.key + constants.frameIndex));
}
