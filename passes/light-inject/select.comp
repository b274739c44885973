#extension GL_KHR_shader_subgroup_ballot : require
// Lists the sides whose radiance may differ from that of the last frame. Their order in the list does not matter,
// since sides are independent. Defines: SHADOWED 0/1; ONE_LIGHT 0/1/2 as in direct.frag; MOVER_BOXES.
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"
#if SHADOWED
#define SHADOW_MAPS 1
#include "vpls/shadow.glsl"
#endif
#include "scene/movers.glsl"
#include "light-inject/patch.glsl"

layout(local_size_x = 64) in;  // kSidesPerGroup

layout(std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(std430) writeonly buffer Changed { uint sides[]; } changed;
layout(std430) buffer Work { uint x, y, z, count; } work;  // groups of light_inject.comp; length of the list
layout(std430) writeonly buffer Listed { uint sides[]; } listed;

layout(push_constant) uniform Constants {
  float offset;     // cells
  uint relightAll;  // 1: nothing is kept from the last frame
  uint moving;      // 1: something moves
};

#if SHADOWED
uniform samplerBuffer covered;  // kMoverBoxes per layer, see covered.comp

const float kMarginTexels = 4.0;  // reach of the widest filter, and a margin for rounding by the rasteriser

// Whether the map `layer` may have changed where it is read from within a sphere. Compares bounds only: the texels of
// the sphere with those of moving objects.
bool mayChange(uint layer, vec3 centre, float radius, bool directional) {
  vec4 clip = mapsViews.view[layer].worldToClip * vec4(centre, 1.0);
  // A step of 1 m moves a point by 2 / (texels * width of a texel) where w is 1, and by its own distance in depth.
  vec2 texels = vec2(textureSize(mapsDepth, 0).xy), at = clip.xy / clip.w;
  vec2 metre = 2.0 / (texels * vec2(mapsViews.view[layer].texelWidth, mapsViews.view[layer].texelHeight));
  vec2 reach = directional ? radius * metre : radius * (metre + abs(at)) / (clip.w - radius);
  reach += kMarginTexels * 2.0 / texels;
  // Outside of the map, its border is used.
  vec2 from = clamp(at - reach, -1.0, 1.0), to = clamp(at + reach, -1.0, 1.0);
  bool any_ = false, meets = false;
  for (uint box = 0u; box < kMoverBoxes; ++box) {
    vec4 moved = texelFetch(covered, int(layer * kMoverBoxes + box));
    bool used = moved.x <= moved.z;
    any_ = any_ || used;
    meets = meets || (used && all(lessThanEqual(from, clamp(moved.zw, -1.0, 1.0))) &&
                      all(greaterThanEqual(to, clamp(moved.xy, -1.0, 1.0))));
  }
  if (!directional && clip.w < -radius) return false;                   // behind the light: never in shadow
  return meets || (any_ && !directional && clip.w <= 1.1 * radius);     // reaches to the light's plane
}

// Whether the light's shadow on a sphere may differ from that of the last frame.
bool shadowMayChange(LightRecord light, vec3 centre, float radius) {
  uint type = light.type, layer = light.firstShadowLayer;
#if ONE_LIGHT == 2
  return mayChange(0u, centre, radius, type == kLightDirectional);
#endif
  for (uint face = 0u; face < (type == kLightPoint ? 6u : 1u); ++face)
    if (mayChange(layer + face, centre, radius, type == kLightDirectional)) return true;
  return false;
}
#endif

// If not `asked`, the loops take no turns, which a CPU device skips.
bool mayDiffer(uint number, bool asked) {
#if SHADOWED
  VoxelGrid grid = voxelsGrid();
  VoxelSide side = loadSide(number);
  // No patch extends farther: half a cell along each axis, at a slope of at most 45 degrees.
  float radius = (1.4143 + offset) * grid.cell;
  bool may = false;
  uint lightCount = moving == 0u || !asked || !(side.area > 0.0) ? 0u : frame.lightCount;
#if ONE_LIGHT
  for (uint i = 0u; i < lightCount; ++i) may = may || shadowMayChange(lights[0], side.position, radius);
#else
  for (uint i = 0u; i < lightCount; ++i) may = may || shadowMayChange(lights[i], side.position, radius);
#endif
  return may;
#else
  return false;
#endif
}

void main() {
  uint voxels = voxelsInfo.value.voxels, number = gl_GlobalInvocationID.x;
  bool inList = number < 2u * voxels;
  bool all_ = relightAll != 0u || number / 2u >= voxelsInfo.value.staticVoxels,
       may = mayDiffer(number, inList && !all_);
  bool anew = inList && (all_ || may);
  if (inList && !anew) changed.sides[number] = 0u;  // otherwise light_inject.comp sets it
  uvec4 ballot = subgroupBallot(anew);
  uint first = 0u;
  uint total = subgroupBallotBitCount(ballot);
  if (total == 0u) return;
  if (subgroupElect()) {
    first = atomicAdd(work.count, total);
    atomicMax(work.x, (first + total - 1u) / kSidesPerGroup + 1u);
  }
  first = subgroupBroadcastFirst(first);
  if (!anew) return;
  uint place = first + subgroupBallotExclusiveBitCount(ballot);
  listed.sides[place] = number;
}
