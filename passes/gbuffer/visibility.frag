// The visible triangle; everything else is computed once per pixel in resolve.frag. Defines: TESTED 0/1, 1 for
// materials that have to be looked up; CULL 0/1; PASSAGE 0/1, 1 where alphaMode BLEND and thin glass let some of the
// eye's rays through (stochastic transparency: Enderton et al., I3D 2010).
#include "scene/drawn_triangle.glsl"
#include "materials/passage.glsl"
#include "scene/scene.glsl"

#if TESTED
layout(location = 0) in vec2 uv;
layout(location = 3) in float alpha;  // of the vertex colours
#if PASSAGE
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 toEye;
#endif
#endif

layout(location = 0) out uint visible;

void main() {
  uint triangle = drawnTriangle();
#if TESTED
  uint material = materialOf(sceneTriangle(triangle));
#if CULL
  if (!gl_FrontFacing && !loadMaterial(material).doubleSided) discard;
#endif
#if PASSAGE
  // The same decision as in look() of rays/surfaces.glsl.
  uint key = hashCombine(hashCombine(frame.seed, kPassageStream), triangle);
  float chance = passageChance(key, uvec2(gl_FragCoord.xy), frame.index);
  if (!stops(material, uv, alpha, abs(dot(normalize(normal), normalize(toEye))), chance)) discard;
#else
  if (!(coverage(material, uv, alpha) > kEitherWay)) discard;
#endif
#endif
  visible = triangle;
}
