// What lets light through in front of what is visible. a: the number of its surfaces; rgb: the logarithms of the
// colours of glass relative to their means, which add up. The share of light that goes through is in the number of rays
// that do (visibility.frag). Define: CULL 0/1.
#include "scene/drawn_triangle.glsl"
#include "materials/passage.glsl"
#include "scene/scene.glsl"

const float kNothingCovered = 0.5 / 255.0;  // an alpha of 0

layout(location = 0) in vec2 uv;
layout(location = 3) in float alpha;  // of the vertex colours
layout(location = 0) out vec4 tint;

void main() {
  uint material = materialOf(sceneTriangle(drawnTriangle()));
  uint flags = uint(texelOf(sceneMaterials, int(material) * kMaterialTexels + kColorTexture).w);
  if ((flags & (kMaterialTransmits | kMaterialBlended)) == 0u) discard;
#if CULL
  if (!gl_FrontFacing && (flags & kMaterialDoubleSided) == 0u) discard;
#endif
  bool glass = (flags & kMaterialTransmits) != 0u;
  if (!glass && coverage(material, uv, alpha) < kNothingCovered) discard;
  tint = vec4(glass ? log(glassTint(material, uv)) : vec3(0.0), 1.0);
}
