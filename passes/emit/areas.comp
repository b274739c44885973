// The area of a VPL: pi r^2 / k, where r is the distance to the k-th nearest VPL whose normal is within 60 degrees,
// which is unbiased for the inverse of the density of a Poisson process; but at most that of the scene's bounding box.
// Define: NEIGHBOURS, k.
#include "scene/scene.glsl"
#include "records/light_paths.h"
#include "records/vpl.h"

layout(local_size_x = 64) in;

VALUE(readonly, LightPaths, progress);
LIST(restrict, Vpl, found);

const float kNone = 3.4e38;

void main() {
  uint i = gl_GlobalInvocationID.x, stored = progress.value.stored;
  if (i >= stored) return;
  vec3 position = found.list[i].position, normal = found.list[i].normal;
  float nearest[NEIGHBOURS];  // squared distances, ascending
  for (int k = 0; k < NEIGHBOURS; ++k) nearest[k] = kNone;
  for (uint other = 0u; other < stored; ++other) {
    vec3 to = found.list[other].position - position;
    float d2 = dot(to, to);
    if (d2 >= nearest[NEIGHBOURS - 1] || other == i || dot(normal, found.list[other].normal) < 0.5) continue;
    for (int k = 0; k < NEIGHBOURS; ++k) {
      float nearer = min(nearest[k], d2);
      d2 = max(nearest[k], d2);
      nearest[k] = nearer;
    }
  }
  float among = 0.0, radius2 = 0.0;
  for (int k = 0; k < NEIGHBOURS; ++k)
    if (nearest[k] < kNone) {
      among += 1.0;
      radius2 = nearest[k];
    }
  vec3 size = frame.boundsMax - frame.boundsMin;
  float most = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
  found.list[i].area = among > 0.0 ? min(kPi * radius2 / among, most) : most;
}
