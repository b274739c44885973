// Importance of VPLs (passes/README.md, importance): with w_i the foveated weight of the first voxel
// side in direction i,
//   I = sum(w_i cos_i) / sum(cos_i),
// or (CONES) w_i the mean weight in a cone around it, from the mips. The directions depend on the VPL's normal alone,
// so that I is stable from frame to frame: Eq. 1 compares it with the I of the previous frame, and noise would delete
// VPLs in a still image. Defines: CANDIDATES 1: the list `candidates`, 0: `vpls`; CONES 0/1; LUMINANCE 0/1;
// VPLS: VPLs per work group.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpls/paraboloid.glsl"
#include "records/hemisphere_rays.h"
#include "voxels/voxel_trace.glsl"
#if CONES
#define CONE_WEIGHT
#include "voxels/cone.glsl"
#endif

// One invocation per direction. Those of a VPL are adjacent, as they start from the same position.
const int kVpls = VPLS;
layout(local_size_x = kHemisphereRays, local_size_y = kVpls) in;

#if CANDIDATES
uniform usamplerBuffer candidates;
layout(std430) writeonly buffer CandidateImportance { float importance[]; };
#else
uniform usamplerBuffer vpls;
layout(std430) writeonly buffer VplImportance { float importance[]; };
#endif
LARGE_TEXELS(float, weights);
#if LUMINANCE
LARGE_TEXELS(vec4, radiance);
#endif
layout(std430) buffer Counters { uint counters[]; };  // rays

layout(push_constant) uniform Constants {
  uint count;
  float luminanceFloor;
};

shared float seen[kVpls][kHemisphereRays];  // w_i cos_i

struct Source {
  vec3 position, normal;
  uint side;
  bool live;
};

Source loadSource(uint i) {
#if CANDIDATES
  Candidate c = loadCandidate(candidates, i);
  return Source(c.position, c.normal, c.side, c.side != kNoSide);
#else
  VplState v = loadVplState(vpls, i);
  return Source(v.position, v.normal, v.side, v.life > 0.0);
#endif
}

float sideWeight(uint side) { return side == kNoSide ? 0.0 : texelOf(weights, int(side)).r; }

#if CONES
// The mean weight of the surfaces in a cone of 60 degrees; where the cone leaves the scene, the
// weight is 0. Its beginning, where the mips cannot tell other surfaces from the VPL's own, is a ray
// (see gatherHemisphere in voxels/cone.glsl).
float weightSeen(Source source, vec3 direction, float cosine) {
  VoxelGrid grid = voxelsGrid();
  MipGrid mips = mipGrid(grid);
  float start = kOwnReach / cosine;
  uint side = traceVoxels(grid, source.position, direction, source.normal, (start + 2.0 * kOwnReach) * mips.cell).side;
  if (side != kNoSide) return sideWeight(side);
  return coneTrace(mips, (source.position - mips.origin) / mips.cell, direction, start, cosine / kOwnReach).weight;
}
#else
float weightSeen(Source source, vec3 direction, float cosine) {
  return sideWeight(traceVoxels(voxelsGrid(), source.position, direction, source.normal).side);
}
#endif

void main() {
  uint i = gl_GlobalInvocationID.y, vpl = gl_LocalInvocationID.y, ray = gl_LocalInvocationID.x;
  bool live = false;
  Source source;
  if (i < count) {
    source = loadSource(i);
    live = source.live;
  }
  vec3 local = kHemisphereRay[ray];
  vec3 direction = toWorld(orthonormalFrame(source.normal), local);
  seen[vpl][ray] = live ? local.z * weightSeen(source, direction, local.z) : 0.0;
  barrier();
  if (ray != 0u || i >= count) return;
  float sum = 0.0;
  for (int k = 0; k < kHemisphereRays; ++k) sum += seen[vpl][k];
  float result = clamp(sum / kHemisphereCosines, 0.0, 1.0);
#if LUMINANCE
  if (live) result *= mix(luminanceFloor, 1.0, clamp(frame.exposure * texelOf(radiance, int(source.side)).w, 0.0, 1.0));
#endif
  importance[i] = result;
  if (live) atomicAdd(counters[0], uint(kHemisphereRays));
}
