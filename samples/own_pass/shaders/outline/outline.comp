layout(local_size_x = 8, local_size_y = 8) in;
uniform texture2D picture;
uniform texture2D gbufferDistance;  // from the eye, m
uniform texture2D gbufferNormal;
layout(rgba8) uniform writeonly image2D image;
layout(push_constant) uniform Constants { float strength; };

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = imageSize(image) - 1;
  if (any(greaterThan(p, last))) return;
  float line = 0.0, distanceHere = texelFetch(gbufferDistance, p, 0).r;
  for (int i = 0; i < 2; ++i) {
    ivec2 q = min(p + ivec2(i, 1 - i), last);
    float turn = 1.0 - dot(texelFetch(gbufferNormal, p, 0).xyz, texelFetch(gbufferNormal, q, 0).xyz);
    float jump = abs(texelFetch(gbufferDistance, q, 0).r / max(distanceHere, 1e-3) - 1.0);
    line = max(line, max(smoothstep(0.05, 0.3, turn), smoothstep(0.02, 0.1, jump)));
  }
  imageStore(image, p, texelFetch(picture, p, 0) * vec4(vec3(1.0 - strength * line), 1.0));
}
