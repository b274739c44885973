// The visible triangle; everything else is computed once per pixel in resolve.frag.
#include "common/scene.glsl"

#if TESTED
layout(location = 0) in vec2 uv;
#endif

layout(location = 0) out uint seen;

layout(push_constant) uniform Constants { uint firstTriangle; };

void main() {
  uint triangle = firstTriangle + uint(gl_PrimitiveID);
#if TESTED
  uint material = materialOf(sceneTriangle(triangle));
#if CULL
  if (!gl_FrontFacing && !loadMaterial(material).doubleSided) discard;
#endif
  if (!alphaTest(material, uv)) discard;
#endif
  seen = triangle;
}
