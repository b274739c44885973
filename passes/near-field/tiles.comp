// Divides the picture into tiles and lists the blocks that have a sample, in any order. Define: RAY_PASSAGE 0/1
// (rays/trace.glsl), MAP_ALONE 0/1, 1 if lamps send no light here.
#include "screen/blocks.glsl"
#include "sampling/fovea.glsl"
#include "rays/surfaces.glsl"
#include "records/near_field.h"

layout(local_size_x = 64) in;

LIST(writeonly, NearFieldTile, tiles);
LIST(writeonly, uint, items);
VALUE(restrict, uint, listed);
LIST(restrict, uint, dispatch);
COUNTERS { uint rays, shaded, gathered; } counters;

layout(push_constant) uniform Constants {
  float foveaRadius;
  uint spacing;
  uint frameIndex;
} constants;

// Whether a lamp is so close that its light differs within a wide block, by what the pixel in its middle shows.
bool isCloseToEmitter(ivec2 corner) {
#if MAP_ALONE
  return false;
#else
  if (emitterCount() == 0u) return false;
  ivec2 middle = clamp(corner + int(constants.spacing / 2u), ivec2(0), ivec2(viewSize()) - 1);
  TracedSurface v = look(vec2(middle) + 0.5);
  if (!v.there || emitted(v) != vec3(0.0)) return false;
  float angle = distance(normalize(pixelRay(middle + ivec2(1, 0))), normalize(pixelRay(middle)));
  return isEmitterWithin(v.position, kClose * float(constants.spacing) * angle * distance(v.position, view.eye));
#endif
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(tiles.list.length())) return;
  ivec2 corner = tileCorner(tileOf(index, constants.spacing), constants.spacing, constants.frameIndex),
        texels = ivec2(texelCount());
  Fovea fovea = makeFovea(view.gaze, view.size, constants.foveaRadius);
  vec2 nearest = clamp(fovea.centre, vec2(corner), vec2(corner + int(constants.spacing)));
  bool narrow = distance(nearest, fovea.centre) <= fovea.radius || isCloseToEmitter(corner);
  tiles.list[index] = NearFieldTile(vec3(0.0), uint(narrow), vec3(0.0), 0u);

  ivec2 first = max(corner, ivec2(0)) / 2, end = min((corner + int(constants.spacing)) / 2, texels);
  if (any(greaterThanEqual(first, end))) return;
  uint number = narrow ? uint((end.x - first.x) * (end.y - first.y)) : 1u, at = atomicAdd(listed.value, number);
  uint groups = (at + number + kItemsInGroup - 1u) / kItemsInGroup;
  atomicMax(dispatch.list[0], min(groups, kMostGroups));
  atomicMax(dispatch.list[1], (groups + kMostGroups - 1u) / kMostGroups);
  if (!narrow) items.list[at] = index | kWideItem;
  for (int y = first.y; narrow && y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) items.list[at++] = uint(y * texels.x + x);
  atomicAdd(counters.rays, rayCount);
}
