// Moves pixels and their samples with the triangles on which they lie. If they stayed where they were, a sample would
// soon lie behind its surface or before it, where no pixel can see it, and its light would be lost.
#include "sampling/reservoir.glsl"
#include "scene/motion.glsl"
#include "screen/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

SURFACES(previous, previousAt)
layout(rgba16f) uniform readonly image2D previousNormal;
layout(rg16_snorm) uniform readonly image2D previousFace;
layout(r32ui) uniform readonly uimage2D previousId;
layout(r32ui) uniform readonly uimage2D previousTriangle;
LARGE_TEXELS(vec4, samples);
layout(rgba32f) uniform writeonly image2D movedPosition;
layout(rgba16f) uniform writeonly image2D movedNormal;
layout(rg16_snorm) uniform writeonly image2D movedFace;
layout(std430) writeonly buffer ReservoirBlock { Reservoir list[]; } reservoirs;

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(previousDistance);
  if (any(greaterThanEqual(p, size))) return;
  vec4 place = previousAt(p), normal = imageLoad(previousNormal, p);
  vec3 face = octDecode(imageLoad(previousFace, p).xy);
  if (place.w > 0.0 && imageLoad(previousId, p).r >> 16 != 0u) {
    uvec4 triangle = sceneTriangle(imageLoad(previousTriangle, p).r);
    mat3 turn = turnSince(triangle);
    place = vec4(movedTo(place.xyz, triangle), objectVisible(triangle.w >> 16) ? place.w : 0.0);
    normal.xyz = turn * normal.xyz;
    face = turn * face;
  }
  imageStore(movedPosition, p, place);
  imageStore(movedNormal, p, normal);
  imageStore(movedFace, p, vec4(octEncode(face), 0.0, 0.0));

  int i = p.y * size.x + p.x;
  Reservoir r = loadReservoir(samples, i);
  uint index = frame.firstMovingTriangle + uint(max(r.mover - 1.0, 0.0));
  if (r.mover > 0.0 && index < frame.triangleCount) {
    uvec4 triangle = sceneTriangle(index);
    r.position = movedTo(r.position, triangle);
    r.normal = turnSince(triangle) * r.normal;
    if (!objectVisible(triangle.w >> 16)) r.weight = 0.0;
  }
  reservoirs.list[i] = r;
}
