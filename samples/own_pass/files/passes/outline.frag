uniform texture2D picture, gbufferPosition, gbufferNormal;
layout(push_constant) uniform Constants { float strength; };
layout(location = 0) out vec4 image;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), q = min(p + 1, textureSize(picture, 0) - 1);
  vec4 here = texelFetch(gbufferPosition, p, 0), there = texelFetch(gbufferPosition, q, 0);
  float turn = dot(texelFetch(gbufferNormal, p, 0).xyz, texelFetch(gbufferNormal, q, 0).xyz);
  bool edge = turn < 0.8 || abs(here.w - there.w) > 0.05 * here.w;
  image = texelFetch(picture, p, 0) * (edge ? 1.0 - strength : 1.0);
}
