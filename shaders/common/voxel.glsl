// The voxel grid in which VPLs are found. The same formulas as framework/shader_twins/voxel_grid.h. Needs
// common/scene.glsl.
#ifndef FOVEA_VOXEL_GLSL
#define FOVEA_VOXEL_GLSL

// Cubic cells, `resolution` of them along the longest axis of the scene's bounds; the volume is a cube of cells.
struct VoxelGrid {
  vec3 origin;      // world space, corner of cell (0, 0, 0)
  float cell;       // edge, m
  int resolution;
};

VoxelGrid voxelGrid(uint resolution) {
  vec3 extent = max(frame.boundsMax.xyz - frame.boundsMin.xyz, vec3(0.0));
  float longest = max(max(extent.x, extent.y), max(extent.z, 1e-3));
  float pad = 1e-3 * longest;
  return VoxelGrid(frame.boundsMin.xyz - pad, (longest + 2.0 * pad) / float(resolution), int(resolution));
}

vec3 worldToVoxel(VoxelGrid grid, vec3 position) { return (position - grid.origin) / grid.cell; }
vec3 voxelToWorld(VoxelGrid grid, vec3 voxel) { return grid.origin + voxel * grid.cell; }
bool insideGrid(VoxelGrid grid, ivec3 cell) {
  return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(grid.resolution)));
}

// A voxel has two opposing sides. A surface belongs to side 1 when the largest component of its geometric normal is
// negative (ties: x before y before z), so that the faces of a thin wall fall on different sides.
uint voxelSideOf(vec3 normal) {
  vec3 a = abs(normal);
  float dominant = a.x >= a.y && a.x >= a.z ? normal.x : a.y >= a.z ? normal.y : normal.z;
  return dominant < 0.0 ? 1u : 0u;
}

// The bundle "voxels" (pass voxelize): an index volume and a compact list of the voxels that hold surface.
//   index    r32ui, R^3: 0 empty, else 1 + number of the voxel
//   occupied r32ui, a texel for each brick of kBrickCells: a bit for each cell that holds a voxel, see occupiedBit()
//   surface  kVoxelSideTexels vec4 a side; side = 2 * voxel + voxelSideOf(geometric normal)
//   info     VoxelInfo
// Voxels of static surfaces come first, ordered by linear cell index x + R (y + R z). Those of dynamic objects follow
// in the same order and hide the static voxel of their cell, as the volume refers to the dynamic one.
const ivec3 kBrickCells = ivec3(4, 4, 2);
ivec3 occupiedBrick(ivec3 cell) { return cell >> ivec3(2, 2, 1); }
uint occupiedBit(ivec3 cell) { return 1u << (cell.x & 3 | (cell.y & 3) << 2 | (cell.z & 1) << 4); }

const int kVoxelSideTexels = 4;
struct VoxelSide {
  vec3 position;     // average over the side's surface, world space
  float area;        // m^2 of surface, 0 if the side is empty
  vec3 normal;       // average, unit
  float object;
  vec3 reflectance;  // average; the texel's fourth component is sideTriangle()
  vec3 emission;     // average, W/(sr m^2)
};

struct VoxelInfo {
  uint voxels;        // in the list
  uint staticVoxels;  // number of the leading static ones
  uint overflow;      // voxels for which there was no room
  uint resolution;    // R
};

#endif
