// Where each probe shall stand, and whether it is inside geometry (Majercik et al., "Scaling Probe-Based Real-Time
// Dynamic Global Illumination for Production", JCGT 10(2), 2021, sections 4 and 5).
#include "device/texels.glsl"
#include "probes/layout.glsl"

layout(local_size_x = 64) in;

layout(std140) uniform RaysGridBlock { ProbeGrid value; } raysGrid;
uniform samplerBuffer raysDirections;  // xyz: unit
LARGE_TEXELS(vec4, raysHits);  // a: distance, below 0 at backs, 0 if there is no ray
uniform samplerBuffer historyStates;
layout(std430) writeonly buffer ProbesStatesBlock { Probe value[]; } probesStates;

layout(push_constant) uniform Constants {
  float insideShare, clearance;
  uint placingFrames;
};

const float kFarthest = 0.45;  // a probe stays this close to the centre of its cell, in spacings
const float kLeastMove = 0.01;  // shorter ones are not worth it to begin anew, in spacings

void main() {
  int probe = int(gl_GlobalInvocationID.x), rays = int(raysGrid.value.rays);
  if (probe >= probesStates.value.length()) return;
  Probe old = loadProbe(historyStates, probe);
  float backs = 0.0, traced = 0.0;
  vec4 back = vec4(vec3(0.0), 1e30), front = back, farthest = vec4(0.0);  // direction and distance
  for (int ray = probe < probesOf(raysGrid.value) ? 0 : rays; ray < rays; ++ray) {
    float hit = texelOf(raysHits, probe * rays + ray).a;
    vec4 seen = vec4(texelFetch(raysDirections, ray).xyz, hit < 0.0 ? -hit / kBackShortened : hit);
    if (hit < 0.0 && seen.w < back.w) back = seen;
    if (hit > 0.0 && seen.w < front.w) front = seen;
    if (hit > 0.0 && seen.w > farthest.w) farthest = seen;
    backs += hit < 0.0 ? 1.0 : 0.0;
    traced += hit != 0.0 ? 1.0 : 0.0;
  }
  bool inside = backs > insideShare * traced;
  float spacing = raysGrid.value.spacing, clear = clearance * spacing;
  vec3 move = vec3(0.0);
  if (inside) {  // out through the nearest back
    move = back.xyz * (back.w + 0.5 * clear);
  } else if (front.w < clear) {  // towards where there is most room, unless the surface is there, too
    if (dot(front.xyz, farthest.xyz) <= 0.0) move = farthest.xyz * min(farthest.w, clear);
  } else if (old.offset != vec3(0.0)) {  // back as far as there is room
    move = -old.offset * min((front.w - clear) / length(old.offset), 1.0);
  }
  vec3 offset = old.offset + move;
  bool moves = old.placings < float(placingFrames) && length(move) > kLeastMove * spacing &&
               length(offset) < kFarthest * spacing;
  Probe next = old;
  if (moves) next.offset = offset;
  next.frames = moves || inside ? 0.0 : min(old.frames + 1.0, 1e6);
  next.inside = inside ? 1.0 : 0.0;
  next.placings = min(old.placings + 1.0, 1e6);
  probesStates.value[probe] = next;
}
