// Holes of alpha-masked materials let light through, and with full materials so do alphaMode BLEND and thin glass: at
// random texels, the same ones whenever the map is drawn. All other surfaces block it on both sides.
#include "common/device/fragment.glsl"
#include "common/passage.glsl"
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;

void main() {
  uint triangle = drawnTriangle();
  uvec2 texel = uvec2(gl_FragCoord.xy);
  float chance = uniformFloat(hashCombine(texel.x << 16 | texel.y, triangle));
  if (!stops(materialOf(sceneTriangle(triangle)), uv, kMeanCosine, chance)) discard;
}
