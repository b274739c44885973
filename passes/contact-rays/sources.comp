// The weights of VPLs: what they send, times the chance that a ray reaches them.
#include "records/contact.h"
#include "records/vpl.h"
#include "scene/scene.glsl"
#include "contact_sources.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) readonly buffer HistoryBlock { vec2 list[]; } history;
layout(std430) writeonly buffer SourcesBlock { ContactSources list[]; } sources;

void main() {
  uint i = gl_GlobalInvocationID.x, all = uint(sources.list.length()), each = all / kContactSubsets;
  if (i >= all) return;
  ContactSources four = ContactSources(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0),
                                       vec4(0.0));
  for (int k = 0; k < 4; ++k) {
    uint slot = slotOf(i / each, i % each * 4u + uint(k));
    if (slot >= uint(vpls.list.length())) continue;
    Vpl vpl = vpls.list[slot];
    vec2 tally = history.list[slot];
    float power = dot(vpl.intensity, vec3(1.0)), chance = max((tally.y + 1.0) / (tally.x + 1.0), kLeastChance);
    four.x[k] = vpl.position.x;
    four.y[k] = vpl.position.y;
    four.z[k] = vpl.position.z;
    four.normalX[k] = vpl.normal.x;
    four.normalY[k] = vpl.normal.y;
    four.normalZ[k] = vpl.normal.z;
    four.area[k] = vpl.area / kPi;
    four.weight[k] = power > 0.0 ? chance * power : 0.0;
  }
  sources.list[i] = four;
}
