// The samples as images: those of narrow blocks as they were traced, those of wide tiles filtered. Define: GLOSS 0/1, 1
// to do the same with the light under lobes.
#include "screen/blocks.glsl"
#include "records/near_field.h"
#include "scene/scene.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer TilesBlock { NearFieldTile list[]; } tiles;
layout(std430) readonly buffer TracedBlock { vec4 list[]; } traced;
layout(std430) readonly buffer MeansBlock { vec4 list[]; } means;
layout(rgba16f) uniform writeonly image2D samples;
#if GLOSS
layout(std430) readonly buffer TracedGlossBlock { vec4 list[]; } tracedGloss;
layout(std430) readonly buffer MeansGlossBlock { vec4 list[]; } meansGloss;
layout(rgba16f) uniform writeonly image2D gloss;
#endif

layout(push_constant) uniform Constants {
  uint spacing;
  uint frameIndex;
};

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(texel, texelCount()))) return;
  uint number = tileNumber(2u * texel, spacing, frameIndex), place = texel.y * texelCount().x + texel.x;
  bool narrow = tiles.list[number].narrow != 0u;
  vec4 light = narrow ? traced.list[place] : means.list[number];
  imageStore(samples, ivec2(texel), vec4(min(light.rgb, 65504.0), light.a));
#if GLOSS
  vec3 its = narrow ? tracedGloss.list[place].rgb : meansGloss.list[number].rgb;
  imageStore(gloss, ivec2(texel), vec4(min(its, 65504.0), light.a));
#endif
}
