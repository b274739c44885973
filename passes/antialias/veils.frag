// Whether a tile has a pixel at which something lets light through. TILE: its width in pixels.
#include "materials/gloss.glsl"

layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(location = 0) out float tiles;

void main() {
  ivec2 first = TILE * ivec2(gl_FragCoord.xy), end = min(first + TILE, imageSize(gbufferNormal));
  bool veiled = false;
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) veiled = veiled || isVeiled(imageLoad(gbufferNormal, ivec2(x, y)).a);
  tiles = veiled ? 1.0 : 0.0;
}
