// Gives wide tiles the mean of the 3 x 3 tiles around them, as far as they lie on the same surface. A ray is a poor
// estimate, and one that hits something bright would be seen as a spot for many frames. Wider or flatter weights would
// make what has just come into view flicker more, as its brightest sample is dropped. Define: GLOSS 0/1, 1 to do the
// same with the light under lobes.
#include "screen/blocks.glsl"
#include "records/near_field.h"
#include "screen/same_surface.glsl"
#include "scene/scene.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer TilesBlock { NearFieldTile list[]; } tiles;
layout(std430) readonly buffer TracedBlock { vec4 list[]; } traced;
layout(std430) writeonly buffer MeansBlock { vec4 list[]; } means;
#if GLOSS
layout(std430) readonly buffer TracedGlossBlock { vec4 list[]; } tracedGloss;
layout(std430) writeonly buffer MeansGlossBlock { vec4 list[]; } meansGloss;
#endif

layout(push_constant) uniform Constants {
  uint spacing;
  uint frameIndex;
};

// Weight of a tile in a row of three, by its distance from the middle.
float rowWeight(int steps) { return steps == 0 ? kTileMiddleWeight : 1.0; }

// The sample of a wide tile is at its first texel.
uint placeOf(ivec2 tile) { return firstTexel(tileCorner(uvec2(tile), spacing, frameIndex)); }

void main() {
  ivec2 count = ivec2(tileCount(spacing));
  int number = int(gl_GlobalInvocationID.x);
  if (number >= count.x * count.y) return;
  ivec2 middle = ivec2(number % count.x, number / count.x);
  NearFieldTile at = tiles.list[number];
  bool isOutside = any(greaterThanEqual(tileCorner(uvec2(middle), spacing, frameIndex), ivec2(viewSize())));
  if (at.narrow != 0u || isOutside) return;
  vec3 light = vec3(0.0), gloss = vec3(0.0);
  float weights = 0.0;
  ivec2 low = max(middle - 1, 0), high = at.there == 0u ? low - 1 : min(middle + 1, count - 1);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      NearFieldTile other = tiles.list[y * count.x + x];
      if (other.narrow != 0u || other.there == 0u) continue;
      if (!onSamePlane(at.position, at.normal, other.position, other.normal)) continue;
      ivec2 steps = abs(ivec2(x, y) - middle);
      float weight = rowWeight(steps.x) * rowWeight(steps.y);
      uint place = placeOf(ivec2(x, y));
      light += weight * traced.list[place].rgb;
#if GLOSS
      gloss += weight * tracedGloss.list[place].rgb;
#endif
      weights += weight;
    }
  // The code stays that of the tile in the middle.
  means.list[number] = vec4(weights > 0.0 ? light / weights : light, traced.list[placeOf(middle)].a);
#if GLOSS
  meansGloss.list[number] = vec4(weights > 0.0 ? gloss / weights : gloss, 0.0);
#endif
}
