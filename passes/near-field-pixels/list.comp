// Lists the pixels of the mask where the light is not known, in any order.
#include "records/near_field.h"
#include "screen/history.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

IMAGE(r8, readonly, image2D, shadeMask);
IMAGE(rgba16f, readonly, image2D, nearField);
LIST(writeonly, uint, items);
VALUE(restrict, uint, listed);
LIST(restrict, uint, dispatch);

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID);
  if (any(greaterThanEqual(pixel, imageSize(nearField)))) return;
  if (imageLoad(shadeMask, pixel).r == 0.0 || imageLoad(nearField, pixel).a != 0.0) return;
  uint at = atomicAdd(listed.value, 1u), groups = at / kItemsInGroup + 1u;
  items.list[at] = packPixel(pixel);
  if (at % kItemsInGroup > 0u) return;
  atomicMax(dispatch.list[0], min(groups, kMostGroups));
  atomicMax(dispatch.list[1], (groups + kMostGroups - 1u) / kMostGroups);
}
