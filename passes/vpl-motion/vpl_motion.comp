// One slot per invocation: the VPL moves with its object and takes over the surface data of the
// voxel that it reaches.
#include "scene/objects.glsl"
#include "voxels/voxel_trace.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Previous { VplState previous[]; };
layout(std430) writeonly buffer Vpls { VplState vpls[]; };
layout(std430) buffer Counters { uint counters[]; };  // alive, deleted

layout(push_constant) uniform Push {
  float turnCos;  // cosine of the largest angle between the VPL's own normal and its voxel's
};

// Side of this frame's voxel at `position` that is the VPL's surface: it belongs to its object and is the one of the
// two that turned less; kNoSide if there is none.
uint sideAt(vec3 position, vec3 normal, float object) {
  VoxelGrid grid = voxelsGrid();
  vec3 p = worldToVoxel(grid, position);
  if (!(all(greaterThanEqual(p, vec3(0.0))) && all(lessThan(p, vec3(grid.resolution))))) return kNoSide;
  uint voxel = imageLoad(voxelsIndex, ivec3(p)).r;
  if (voxel == 0u) return kNoSide;
  uint found = kNoSide;
  float best = turnCos;
  for (uint side = 2u * voxel - 2u; side < 2u * voxel; ++side) {
    VoxelSide s = loadSide(side);
    float cosine = dot(s.normal, normal);
    if (s.area > 0.0 && s.object == object && cosine >= best && (found == kNoSide || cosine > best)) {
      best = cosine;
      found = side;
    }
  }
  return found;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= uint(previous.length())) return;
  VplState vpl = previous[slot];
  bool lived = vpl.life > 0.0;
  if (lived) {
    uint object = uint(vpl.object);
    bool deforms = objectDeforms(object);
    vec3 position = deforms ? attachedPosition(vpl.localPosition) : fromObject(object, vpl.localPosition);
    vec3 normal = deforms ? triangleAxes(uint(vpl.localPosition.x)) * vpl.localNormal
                          : normalFromObject(object, vpl.localNormal);
    uint side = sideAt(position, normal, vpl.object);
    if (side != kNoSide) {
      VoxelSide surface = loadSide(side);
      vpl.previousImportance = vpl.importance;  // pass `importance` computes the new one
      vpl.position = position;
      vpl.normal = surface.normal;
      vpl.life += 1.0;
      vpl.reflectance = surface.reflectance;
      vpl.side = side;
      vpls[slot] = vpl;
      atomicAdd(counters[0], 1u);
      return;
    }
    atomicAdd(counters[1], 1u);
  }
  vpls[slot] = kNoVplState;
}
