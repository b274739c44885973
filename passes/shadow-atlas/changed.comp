#extension GL_KHR_shader_subgroup_vote : require
// One work group per slot: whether its map would change if it were drawn again. It would not if the VPL has not moved
// and each mover either keeps its pose or lies, then as now, behind the surfaces in the map.
#include "vpls/paraboloid.glsl"
#include "vpls/vpl.glsl"
#include "shadow-atlas/step.glsl"

// No more than a CPU device runs at a time, as reads that all invocations of a slot make cost each of them.
const int kRow = 8;
layout(local_size_x = kRow) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) readonly buffer RefreshedBlock { uint frames[]; } refreshed;  // 0 if there is no map
layout(std430) readonly buffer DrawnBlock { DrawnMap maps[]; } drawn;
layout(std430) writeonly buffer ChangesBlock { uint list[]; } changes;
layout(r32ui) uniform readonly uimage2DArray atlas;

layout(push_constant) uniform Constants {
  vec4 movers[kMovers];  // xyz: centre, w: radius of a sphere around dynamic objects, negative if unused
  uint poses[kMovers];
  uint slots;
};

shared uint found;

// Sets `found` if a surface within the sphere might be visible in the map. Must be called by the whole group.
void look(uint slot, Vpl v, vec4 sphere) {
  if (sphere.w < 0.0) return;
  vec3 to = sphere.xyz - v.position;
  float away = length(to);
  float reach = sphere.w + 1e-4 * (away + sphere.w);  // rounding
  if (dot(to, v.normal) < -reach) return;         // behind the VPL
  AtlasLayout layout_ = atlasLayout(imageSize(atlas));
  vec2 low = vec2(0.0), high = vec2(layout_.size - 1);
  if (away > reach) {
    // The image of the cone around a sphere is a circle, whose nearest and farthest points lie on the line through
    // the centre of the map. Beyond 150 degrees from the normal, the whole map is assumed.
    vec3 local = toLocal(orthonormalFrame(v.normal), to) / away;
    float angle = acos(clamp(local.z, -1.0, 1.0)), half_ = asin(reach / away);
    if (angle + half_ < 2.6) {
      float inner = tan(0.5 * (angle - half_)), outer = tan(0.5 * (angle + half_)), along = length(local.xy);
      vec2 direction = along > 0.0 ? local.xy / along : vec2(1.0, 0.0);
      vec2 centre = 0.5 * (inner + outer) * direction;
      float radius = 0.5 * (outer - inner), texel = 2.0 / float(layout_.size);
      low = max(low, floor((centre - radius + 1.0) / texel - 1.5));
      high = min(high, ceil((centre + radius + 1.0) / texel + 0.5));
    }
  }
  ivec2 first = ivec2(low), last = ivec2(high);
  ivec3 corner = atlasTexel(slot, ivec2(0), layout_);
  float nearest = away - reach;
  bool any_ = nearest <= 0.0;  // one is enough, and usually found early
  for (int y = first.y; y <= last.y && !any_; ++y)
    for (int row = first.x; row <= last.x && !any_; row += kRow) {
      int x = row + int(gl_LocalInvocationIndex);
      vec2 p = paraboloidTexelCentre(ivec2(x, y), layout_.size);
      float distance_ = uintBitsToFloat(imageLoad(atlas, corner + ivec3(min(x, last.x), y, 0)).r);
      any_ = subgroupAny(x <= last.x && dot(p, p) < 1.0 && distance_ >= nearest);
    }
  if (any_) atomicOr(found, 1u);
}

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * kGroupsPerRow;
  if (slot >= slots) return;
  Vpl v = vpls.list[slot];
  bool stands = refreshed.frames[slot] != 0u && drawn.maps[slot].position == v.position &&
                drawn.maps[slot].normal == v.normal;
  if (gl_LocalInvocationIndex == 0u) found = 0u;
  barrier();
  if (stands && isLit(v)) {
    for (uint i = 0u; i < kMovers; ++i) {
      if (drawn.maps[slot].movers[i] == movers[i] && drawn.maps[slot].poses[i] == poses[i]) continue;
      look(slot, v, movers[i]);
      look(slot, v, drawn.maps[slot].movers[i]);
    }
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u)
    changes.list[slot] = !stands ? kChangeAll : found != 0u ? kChangeMovers : kChangeNone;
}
