// Hands on what the rays have found. Among the pixels of each 4 x 4 block that got one ray each, the brightest one
// becomes no brighter than the second: a single ray that hits something in the sun would be a firefly. Means of several
// rays need this less and would lose light.
#include "records/near_field.h"
#include "screen/history.glsl"

layout(local_size_x = 64) in;  // kItemsInGroup

layout(std430) readonly buffer ItemsBlock { uint list[]; } items;
layout(std430) readonly buffer ListedBlock { uint value; } listed;
layout(rgba32f) uniform readonly image2D traced;
layout(rgba16f) uniform writeonly image2D nearField;

layout(push_constant) uniform Constants { uint samples; };

float luminanceOf(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

// The two largest luminances of the block, -1 if it has none.
vec2 brightestAround(ivec2 pixel) {
  ivec2 first = pixel / 4 * 4, end = min(first + 4, imageSize(traced));
  vec2 most = vec2(-1.0);
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) {
      vec4 light = imageLoad(traced, ivec2(x, y));
      float luminance = luminanceOf(light.rgb);
      if (light.a > 0.0) most = vec2(max(most.x, luminance), max(most.y, min(most.x, luminance)));
    }
  return most;
}

void main() {
  uint number = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (number >= listed.value) return;
  ivec2 pixel = unpackPixel(items.list[number]);
  vec4 light = imageLoad(traced, pixel);
  if (light.a == 0.0) return;
  if (samples == 1u) {
    float second = brightestAround(pixel).y, luminance = luminanceOf(light.rgb);
    if (second >= 0.0 && luminance > second) light.rgb *= second / luminance;
  }
  imageStore(nearField, pixel, vec4(min(light.rgb, 65504.0), 1.0));
}
