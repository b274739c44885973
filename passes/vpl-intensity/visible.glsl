// Whether a point of a surface sees a VPL, tested in the voxels. Needs vpl-intensity/vpl_intensity.glsl; `bricks`
// holds the bricks that contain any surface.
#ifndef FOVEA_VISIBLE_GLSL
#define FOVEA_VISIBLE_GLSL

uniform usamplerBuffer bricks;

// Sides block the ray if they face it and lie in front of the start's tangent plane (as in traceVoxels), except for
// those within this distance of the VPL, in cells, and parts of the VPL's own surface within this distance of its
// tangent plane: a ray at a grazing angle meets the layer of its voxels long before its end. Against traced rays,
// weighted by the light they would carry, this loses 1% in the Cornell box and gains none; in Sponza with 128^3 cells
// it loses 16% and gains 11% (without the second exception 21% and 9%).
const float kNearby = 1.5;
const float kSamePlane = 1.0;

struct Segment {
  vec3 from, face, direction;  // face: geometric normal at the start
  vec3 to, normal;             // the VPL
};

bool blocks(VoxelGrid grid, Segment s, uint side) {
  VoxelSide v = loadSide(side);
  vec3 off = v.position - s.to;
  bool faces = v.area > 0.0 && dot(v.normal, s.direction) < 0.0;
  bool own = dot(v.position - s.from, s.face) <= kOwnSurface * grid.cell;
  bool near = dot(off, off) < kNearby * kNearby * grid.cell * grid.cell;
  bool same = dot(v.normal, s.normal) > 0.5 && abs(dot(off, s.normal)) < kSamePlane * grid.cell;
  return faces && !own && !near && !same;
}

// Walks from cell to cell and crosses empty bricks in one step.
bool seesVpl(VoxelGrid grid, vec3 from, vec3 face, vec3 to, vec3 normal) {
  float d = distance(from, to);
  Segment s = Segment(from, face, (to - from) / d, to, normal);
  vec3 p = worldToVoxel(grid, from);  // in cells, as is t
  bvec3 moves = greaterThan(abs(s.direction), vec3(1e-7));
  vec3 inverse = mix(vec3(1e30), 1.0 / s.direction, moves);
  vec3 ahead = mix(vec3(1.0), vec3(greaterThan(s.direction, vec3(0.0))), moves);
  float t = 0.0, end = d / grid.cell - 1.0;
  for (int turn = 0; turn < 3 * grid.resolution + 3 && t < end; ++turn) {
    ivec3 cell = ivec3(floor(p + (t + 1e-3) * s.direction));  // slightly ahead, so that no wall stops it
    if (!insideGrid(grid, cell)) break;
    bool full = texelFetch(bricks, int(brickIndex(grid, cell / kBrick))).r != 0u;
    if (full) {
      uint voxel = imageLoad(voxelsIndex, cell).r;
      if (voxel != 0u && (blocks(grid, s, 2u * voxel - 2u) || blocks(grid, s, 2u * voxel - 1u))) return false;
    }
    vec3 low = vec3(full ? cell : cell / kBrick * kBrick);
    vec3 walls = (low + ahead * (full ? 1.0 : float(kBrick)) - p) * inverse;
    t = max(t, min(min(walls.x, walls.y), walls.z));
  }
  return true;
}

#endif
