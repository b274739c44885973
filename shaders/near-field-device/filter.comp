// Gives wide tiles the mean of the 3 x 3 tiles around them, as far as they lie on the same surface. A ray is a poor
// estimate, and one that hits something bright would be seen as a spot for many frames. Wider or flatter weights would
// make what has just come into view flicker more, as its brightest sample is dropped.
#include "common/blocks.glsl"
#include "common/records/near_field.h"
#include "common/same_surface.glsl"
#include "common/scene.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer TilesBlock { NearFieldTile list[]; } tiles;
layout(std430) readonly buffer TracedBlock { vec4 list[]; } traced;
layout(rgba16f) uniform writeonly image2D samples;

layout(push_constant) uniform Constants { uint spacing; };

// Weight of a tile in a row of three, by its distance from the middle.
float rowWeight(int steps) { return steps == 0 ? kTileMiddleWeight : 1.0; }

// The sample of a wide tile is at its first texel.
vec4 sampleOf(ivec2 tile) {
  ivec2 first = tile * int(spacing) / 2;
  return traced.list[first.y * int(texelCount().x) + first.x];
}

vec3 meanAround(ivec2 middle, ivec2 count) {
  NearFieldTile at = tiles.list[middle.y * count.x + middle.x];
  vec4 sum = vec4(0.0);
  if (at.there == 0u) return vec3(0.0);
  ivec2 low = max(middle - 1, 0), high = min(middle + 1, count - 1);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      NearFieldTile other = tiles.list[y * count.x + x];
      if (other.narrow != 0u || other.there == 0u) continue;
      if (!onSamePlane(at.position, at.normal, other.position, other.normal)) continue;
      ivec2 steps = abs(ivec2(x, y) - middle);
      sum += rowWeight(steps.x) * rowWeight(steps.y) * vec4(sampleOf(ivec2(x, y)).rgb, 1.0);
    }
  return sum.rgb / sum.a;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(samples)))) return;
  ivec2 count = ivec2(tileCount(spacing)), tile = 2 * texel / int(spacing);
  vec4 value;
  if (tiles.list[tile.y * count.x + tile.x].narrow != 0u) value = traced.list[texel.y * int(texelCount().x) + texel.x];
  else value = vec4(meanAround(tile, count), sampleOf(tile).a);
  imageStore(samples, texel, vec4(min(value.rgb, 65504.0), value.a));
}
