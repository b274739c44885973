// Shared by the kernels of pass vpl-intensity. Needs scene/scene.glsl; includes the voxels.
#ifndef FOVEA_WEIGHTS_GLSL
#define FOVEA_WEIGHTS_GLSL

#include "vpls/eye_paths.glsl"
#include "voxels/voxel_trace.glsl"
#include "vpl-intensity/records.h"

const float kAreaUnits = 65536.0;

uint areaUnits(VoxelGrid grid, float area) {
  return uint(min(area / (grid.cell * grid.cell) * kAreaUnits + 0.5, 4.2e9));
}

float unitsToArea(VoxelGrid grid, uint low, uint high) {
  return (float(high) * 4294967296.0 + float(low)) * (grid.cell * grid.cell / kAreaUnits);
}

// Adds to a 64-bit sum in a buffer; the invocation whose addition wraps the low word carries.
#define ADD_WIDE(LOW, HIGH, VALUE) { \
  uint before_ = atomicAdd(LOW, VALUE); \
  if (before_ + (VALUE) < before_) atomicAdd(HIGH, 1u); \
}

// VPLs and ends of eye paths on sides with direct light are kept apart from the others, and so are those on emissive
// sides (kShining), most of whose radiance is emission.
float siteKind(float light, float emission) {
  return emission > 0.5 * light ? kShining : light > 0.0 ? 2.0 : 1.0;
}

// Paths are counted in fixed point, as they may be divided. The direct light at the end of a path is relative to that
// of a VPL, with an upper limit.
const float kPathUnits = 1024.0, kMostLight = 16.0;

uint lightUnits(float light, float ofVpl, uint pathUnits) {
  return uint((ofVpl > 0.0 ? min(light / ofVpl, kMostLight) : 1.0) * float(pathUnits) + 0.5);
}

// See VplSite::handicap.
const float kThinSite = -2.0;

// The part that a VPL keeps of the paths that end nearest to it, see share.comp. p: its density; least: least density
// that counts; seenFrom: number of screen points of which p is an average.
const float kEnoughPoints = 4.0;

float partKept(float p, float least, float seenFrom) {
  return min(min(p / max(least, 1e-30), seenFrom / kEnoughPoints), 1.0);
}

// The largest factor by which a VPL becomes brighter to make up for light that its kernel does not send to nearby
// surfaces. Without a limit, a VPL that lights only nearby surfaces would be far too bright for everything else.
const float kMostGain = 2.0;

// Each of 64 invocations looks at every 64th point, and words of 32 bits say from which of them the VPL is seen.
uint laneWords(uint points) { return (points + 2047u) / 2048u; }

EyePathStart loadStart(samplerBuffer list, uint point) {
  int first = 3 * int(point);
  vec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2);
  return EyePathStart(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w);
}

PathEnd loadPathEnd(samplerBuffer list, uint path) {
  vec4 a = texelFetch(list, 2 * int(path)), b = texelFetch(list, 2 * int(path) + 1);
  return PathEnd(a.xyz, a.w, b.xyz, b.w);
}

VplSite loadSite(samplerBuffer list, uint vpl) {
  vec4 a = texelFetch(list, 2 * int(vpl)), b = texelFetch(list, 2 * int(vpl) + 1);
  return VplSite(a.xyz, a.w, b.xyz, b.w);
}

ivec3 brickGrid(VoxelGrid grid) { return ivec3((grid.resolution + kBrick - 1) / kBrick); }

ivec3 brickOf(VoxelGrid grid, vec3 position) {
  return clamp(ivec3(floor(worldToVoxel(grid, position))), ivec3(0), ivec3(grid.resolution - 1)) / kBrick;
}

uint brickIndex(VoxelGrid grid, ivec3 brick) {
  int n = brickGrid(grid).x;
  return uint(brick.x + n * (brick.y + n * brick.z));
}

// Weight of the normals in the distance between surfaces, m^2: `share` of the squared mean free path 4 V / S of the
// scene (the mean chord of a room of volume V and surface S), so that one value suits scenes of any size.
float normalWeight(VoxelGrid grid, float share, uint areaLow, uint areaHigh) {
  vec3 extent = max(frame.boundsMax - frame.boundsMin, vec3(0.0));
  float path = 4.0 * extent.x * extent.y * extent.z / max(unitsToArea(grid, areaLow, areaHigh), 1e-12);
  return share * path * path;
}

#endif
