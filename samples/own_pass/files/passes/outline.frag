uniform texture2D picture, gbufferDistance, gbufferNormal;
layout(push_constant) uniform Constants { float strength; };
layout(location = 0) out vec4 image;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), q = min(p + 1, textureSize(picture, 0) - 1);
  float here = texelFetch(gbufferDistance, p, 0).r, there = texelFetch(gbufferDistance, q, 0).r;
  float turn = dot(texelFetch(gbufferNormal, p, 0).xyz, texelFetch(gbufferNormal, q, 0).xyz);
  bool edge = turn < 0.8 || abs(here - there) > 0.05 * here;
  image = texelFetch(picture, p, 0) * (edge ? 1.0 - strength : 1.0);
}
