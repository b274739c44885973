// The VPLs in the order of their keys. VPL i belongs to interleave subset i mod n^2, so neighbours fall into different
// subsets, and every subset samples the whole scene evenly.
#include "device/language.glsl"
#include "records/light_paths.h"
#include "records/vpl.h"

layout(local_size_x = 64) in;

VALUE(readonly, LightPaths, progress);
LIST(readonly, Vpl, found);
LIST(readonly, uint, keys);
LIST(writeonly, Vpl, vpls);

layout(push_constant) uniform Constants {
  uint count;
  uint averagedFrames;
} constants;

void main() {
  uint i = gl_GlobalInvocationID.x, stored = progress.value.stored;
  if (i >= constants.count) return;
  if (i >= stored) {
    vpls.list[i] = Vpl(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    return;
  }
  uint own = keys.list[i], place = 0u;
  for (uint other = 0u; other < stored; ++other) {
    uint key = keys.list[other];
    place += uint(key < own || (key == own && other < i));
  }
  Vpl v = found.list[i];
  v.area /= float(constants.averagedFrames);
  vpls.list[place] = v;
}
