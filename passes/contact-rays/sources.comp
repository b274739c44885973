// The weights of VPLs: what they send, times the chance that a ray reaches them.
#include "records/contact.h"
#include "records/vpl.h"
#include "scene/scene.glsl"
#include "contact_sources.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) readonly buffer HistoryBlock { vec2 list[]; } history;
layout(std430) writeonly buffer SourcesBlock { ContactSource list[]; } sources;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(vpls.list.length())) return;
  Vpl vpl = vpls.list[i];
  vec2 tally = history.list[i];
  float power = dot(vpl.intensity, vec3(1.0)), chance = max((tally.y + 1.0) / (tally.x + 1.0), kLeastChance);
  ContactSource light = ContactSource(vpl.position, vpl.area / kPi, vpl.normal, 0.0, vec3(0.0), 0.0);
  if (power > 0.0) {
    light.weight = chance * power;
    light.color = vpl.intensity / light.weight;
  }
  sources.list[i] = light;
}
