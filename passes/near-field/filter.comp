// Gives wide tiles the mean of the 3 x 3 tiles around them, as far as they lie on the same surface. A ray is a poor
// estimate, and one that hits something bright would be seen as a spot for many frames. Wider or flatter weights would
// make what has just come into view flicker more, as its brightest sample is dropped. Define: GLOSS 0/1, 1 to do the
// same with the light under lobes.
#include "screen/blocks.glsl"
#include "records/near_field.h"
#include "screen/same_surface.glsl"
#include "scene/scene.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer TilesBlock { NearFieldTile list[]; } tiles;
layout(std430) readonly buffer TracedBlock { vec4 list[]; } traced;
layout(rgba16f) uniform writeonly image2D samples;
#if GLOSS
layout(std430) readonly buffer TracedGlossBlock { vec4 list[]; } tracedGloss;
layout(rgba16f) uniform writeonly image2D gloss;
#endif

layout(push_constant) uniform Constants { uint spacing; };

// Weight of a tile in a row of three, by its distance from the middle.
float rowWeight(int steps) { return steps == 0 ? kTileMiddleWeight : 1.0; }

// A sample: irradiance / pi and its code, and with GLOSS the light under the lobe.
struct Sample {
  vec4 light;
  vec3 gloss;
};

Sample sampleAt(ivec2 texel) {
  int place = texel.y * int(texelCount().x) + texel.x;
#if GLOSS
  return Sample(traced.list[place], tracedGloss.list[place].rgb);
#else
  return Sample(traced.list[place], vec3(0.0));
#endif
}

// That of a wide tile is at its first texel.
Sample sampleOf(ivec2 tile) { return sampleAt(tile * int(spacing) / 2); }

// The code stays that of the tile in the middle.
Sample meanAround(ivec2 middle, ivec2 count) {
  NearFieldTile at = tiles.list[middle.y * count.x + middle.x];
  Sample sum = Sample(vec4(vec3(0.0), sampleOf(middle).light.a), vec3(0.0));
  if (at.there == 0u) return sum;
  float weights = 0.0;
  ivec2 low = max(middle - 1, 0), high = min(middle + 1, count - 1);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      NearFieldTile other = tiles.list[y * count.x + x];
      if (other.narrow != 0u || other.there == 0u) continue;
      if (!onSamePlane(at.position, at.normal, other.position, other.normal)) continue;
      ivec2 steps = abs(ivec2(x, y) - middle);
      float weight = rowWeight(steps.x) * rowWeight(steps.y);
      Sample its = sampleOf(ivec2(x, y));
      sum.light.rgb += weight * its.light.rgb;
      sum.gloss += weight * its.gloss;
      weights += weight;
    }
  sum.light.rgb /= weights;
  sum.gloss /= weights;
  return sum;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(samples)))) return;
  ivec2 count = ivec2(tileCount(spacing)), tile = 2 * texel / int(spacing);
  Sample value;
  if (tiles.list[tile.y * count.x + tile.x].narrow != 0u) value = sampleAt(texel);
  else value = meanAround(tile, count);
  imageStore(samples, texel, vec4(min(value.light.rgb, 65504.0), value.light.a));
#if GLOSS
  imageStore(gloss, texel, vec4(min(value.gloss, 65504.0), value.light.a));
#endif
}
