// Holes of alpha-masked materials let light through, and with full materials so do alphaMode BLEND and thin glass: at
// some of the texels, the same ones whenever the map is drawn. All other surfaces block it on both sides. Define:
// PASSAGE 0/1, 1 for the latter two.
#include "scene/drawn_triangle.glsl"
#include "materials/passage.glsl"
#include "scene/scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 3) in float alpha;  // of the vertex colours

void main() {
  uint triangle = drawnTriangle(), material = materialOf(sceneTriangle(triangle));
#if PASSAGE
  float chance = passageChance(hashPcg(triangle), uvec2(gl_FragCoord.xy), 0u);
  if (!stops(material, uv, alpha, kMeanCosine, chance)) discard;
#else
  if (!(coverage(material, uv, alpha) > kEitherWay)) discard;
#endif
}
