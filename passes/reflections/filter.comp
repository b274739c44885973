// The mean over 5 x 5 mirrors as far as their lobes overlap: single rays are poor estimates of what wide lobes reflect.
#include "scene/scene.glsl"
#include "mirror.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f) uniform readonly image2D traced;
layout(rgba16f) uniform writeonly image2D samples;
layout(r32f) uniform writeonly image2D distances;

// At which distance, as 1/m, lobes have to overlap for light to be shared. nearness: of what the mirror shows.
float sharingNearness(Mirror m, float nearness) {
  return nearness > 0.0 ? nearness : m.alpha / (kHardlyApart * m.distance_);
}

// The share of a neighbour's light that counts for `m`, too, as far as their lobes overlap at `nearness`, 1/m.
float overlap(Mirror m, Mirror neighbour, float nearness) {
  vec3 to = neighbour.position - m.position;
  if (!neighbour.there || abs(dot(to, m.face)) > kSameSlope * length(to)) return 0.0;
  vec3 turned = 2.0 * (neighbour.normal - m.normal);  // a mirror turns light by twice its own turn
  vec3 parallax = 0.5 * nearness * to;
  float apart = dot(turned, turned) + dot(parallax, parallax);
  float blurred = min(m.alpha / kSharp, 1.0);
  return blurred * blurred * exp(-apart / (m.alpha * m.alpha));
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy), size = imageSize(traced);
  if (any(greaterThanEqual(block, size))) return;
  Mirror m = mirrorAt(block);
  vec4 own = imageLoad(traced, block), sum = vec4(own.rgb, 1.0);
  float nearness = sharingNearness(m, own.a);
  ivec2 low = max(block - kSharing, 0), high = m.there ? min(block + kSharing, size - 1) : low - 1;
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      ivec2 at = ivec2(x, y);
      vec4 its = imageLoad(traced, at);
      Mirror neighbour = mirrorAt(at);
      float nearer = max(nearness, sharingNearness(neighbour, its.a));
      if (at != block) sum += overlap(m, neighbour, nearer) * vec4(its.rgb, 1.0);
    }
  vec3 light = min(sum.rgb / sum.a, 65504.0);
  imageStore(samples, block, vec4(light, m.there ? float(m.code) : kNoMirror));
  imageStore(distances, block, vec4(own.a > 0.0 ? 1.0 / own.a : 0.0));
}
