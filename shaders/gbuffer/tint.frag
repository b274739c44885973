// Glass in front of what is visible: the logarithms of its colours relative to their means, which add up. The share of
// light that goes through is in the number of rays that do (visibility.frag). Define: CULL 0/1.
#include "common/device/fragment.glsl"
#include "common/passage.glsl"
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 tint;

const float kDarkest = 1e-4;

void main() {
  uint material = materialOf(sceneTriangle(drawnTriangle()));
  uint flags = uint(texelOf(sceneMaterials, int(material) * kMaterialTexels + kColorTexture).w);
  if ((flags & kMaterialTransmits) == 0u) discard;
#if CULL
  if (!gl_FrontFacing && (flags & kMaterialDoubleSided) == 0u) discard;
#endif
  vec3 color = max(glassColor(material, uv), kDarkest);
  tint = vec4(log(color / dot(color, vec3(1.0 / 3.0))), 0.0);
}
