// Picks the pixel of each block from which a ray of pass reflections leaves, if its surface is smooth enough for one.
#include "screen/blocks.glsl"
#include "materials/gloss.glsl"

layout(r32f) uniform readonly image2D gbufferDistance;
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(rgba16f) uniform readonly image2D gbufferSpecular;
layout(location = 0) out uvec4 points;

layout(push_constant) uniform Constants { uint frameIndex; };

void main() {
  ivec2 block = ivec2(gl_FragCoord.xy), inside = ivec2(samplePixel(frameIndex, 2u, uvec2(block))),
        p = 2 * block + inside;
  bool there = all(lessThan(p, imageSize(gbufferSpecular)));
  p = there ? p : ivec2(0);
  vec4 specular = imageLoad(gbufferSpecular, p);
  float distance_ = imageLoad(gbufferDistance, p).r;
  there = there && distance_ > 0.0 && tracedShare(specular) > 0.0;
  uint code = uint(2 | inside.x << 4 | inside.y << 7);
  uvec4 point = uvec4(floatBitsToUint(distance_), packSnorm2x16(octEncode(normalize(imageLoad(gbufferNormal, p).xyz))),
                      packSnorm2x16(imageLoad(gbufferFace, p).xy), code | packUnorm2x16(vec2(0.0, specular.a)));
  points = there ? point : uvec4(0u);
}
