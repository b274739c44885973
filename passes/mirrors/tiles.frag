// Whether a tile contains a smooth surface. TILE: its width in pixels.
#include "materials/gloss.glsl"

layout(r32f) uniform readonly image2D gbufferDistance;
layout(rgba16f) uniform readonly image2D gbufferSpecular;
layout(location = 0) out float tiles;

void main() {
  bool full = imageSize(gbufferSpecular) == imageSize(gbufferDistance);  // else materials are diffuse
  ivec2 first = TILE * ivec2(gl_FragCoord.xy), end = full ? min(first + TILE, imageSize(gbufferSpecular)) : first;
  bool smooth_ = false;
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x)
      smooth_ = smooth_ || tracedShare(imageLoad(gbufferSpecular, ivec2(x, y))) > 0.0;
  tiles = smooth_ ? 1.0 : 0.0;
}
