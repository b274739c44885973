// Cone tracing through the bundle `voxel-mips` (pass mipmap), and the light that arrives over a hemisphere (Crassin et
// al., "Interactive Indirect Illumination Using Voxel Cone Tracing", 2011).
//
// Define: CONE_WEIGHT, if the weights are needed beside the light; CONE_GATHER, if gatherHemisphere() is.
//
// Needs scene/scene.glsl and the port `mips` (Usage::Sampled); with CONE_GATHER also the ports of
// voxels/voxel_trace.glsl and the port `radiance`, a buffer of one vec4 for each voxel side.
#ifndef FOVEA_CONE_GLSL
#define FOVEA_CONE_GLSL

#include "device/texels.glsl"
#include "voxels/voxel.glsl"

uniform texture3D mipsColor;
#ifdef CONE_WEIGHT
uniform texture3D mipsWeight;
#endif
uniform sampler linearClamp;

// Level l has `size` / 2^l cells per side. Positions are in cells of level 0, which are two voxels wide.
struct MipGrid {
  vec3 origin;   // world space, m
  float cell;    // of level 0, m
  int size;
  int levels;    // levels that each halve the one before: all, if the size is a power of two
  bool faces;    // six faces side by side in x; if false, one volume
};

// The mips of the port `mips` over a voxel grid.
MipGrid mipGrid(VoxelGrid grid) {
  ivec3 size = textureSize(mipsColor, 0);
  return MipGrid(grid.origin, 2.0 * grid.cell, size.y, findLSB(size.y) + 1, size.x > size.y);
}

// Surface is stored as coverage: its area (projected on the face, if there are faces) relative to the area of a
// cell's face. Along a ray it sums to sum(coverage * step / cell), which is 1 after the ray has crossed one
// surface, whatever the angle; for projected areas this holds because the coverage towards direction w is sum(|w_k|
// face_k). Multiplying transparencies instead would let a seventh of the light through a solid wall, since
// filtering spreads the wall over two cells. rgb: radiance times coverage; a: coverage, which exceeds 1 where a
// cell holds several surfaces.
struct ConeSample {
  vec4 color;
  float weight;  // also times the coverage; 0 without CONE_WEIGHT
};

// A filtered texel of one face. at: place in the grid, from 0 to 1; face: its number; faceCount: 6, or 1 if there is
// one volume.
ConeSample mipFetch(vec3 at, float face, float faceCount, float level) {
  vec3 uvw = vec3((face + at.x) / faceCount, at.yz);
  ConeSample s;
  s.color = textureLod(sampler3D(mipsColor, linearClamp), uvw, level);
#ifdef CONE_WEIGHT
  s.weight = textureLod(sampler3D(mipsWeight, linearClamp), uvw, level).r;
#else
  s.weight = 0.0;
#endif
  return s;
}

// The surfaces around p (cells of level 0) that face the direction of a ray, which is unit, interpolated between
// levels.
ConeSample sampleMips(MipGrid grid, vec3 p, vec3 direction, float level) {
  float size = float(grid.size);
  float half_ = 0.5 * exp2(ceil(level)) / size;
  vec3 at = clamp(p / size, half_, 1.0 - half_);  // filtering must not reach into the next face
  if (!grid.faces) return mipFetch(at, 0.0, 1.0, level);
  // Faces are ordered +x -x +y -y +z -z by the direction that a surface faces: a ray towards +x meets
  // surfaces that face -x.
  vec3 towards = abs(direction);
  vec3 face = vec3(0.0, 2.0, 4.0) + vec3(greaterThan(direction, vec3(0.0)));
  ConeSample x = mipFetch(at, face.x, 6.0, level), y = mipFetch(at, face.y, 6.0, level),
             z = mipFetch(at, face.z, 6.0, level);
  return ConeSample(towards.x * x.color + towards.y * y.color + towards.z * z.color,
                    dot(towards, vec3(x.weight, y.weight, z.weight)));
}

const float kConeStep = 0.5;  // in cells of the level
const int kConeTurns = 512;

// Traces a cone front to back. origin, start: cells of level 0; direction: unit; growth: width of the filter's cells
// relative to the distance. The filter has to widen smoothly: if it jumped from one level to the next in front of a
// wall, the part of the wall that the fine level has not shown yet and the coarse one no longer shows would be lost.
// Returns radiance and weight premultiplied with the coverage that was met, which is at most 1.
ConeSample coneTrace(MipGrid grid, vec3 origin, vec3 direction, float start, float growth) {
  ConeSample sum = ConeSample(vec4(0.0), 0.0);
  float t = start;
  // A wall may stand half a cell behind the middle of its cell. By then the filter is wider by this much, and the sum
  // over the wall smaller. As a complete wall must hide everything, coverage counts this much more.
  float opaque = 1.0 + 0.5 * growth;
  for (int turn = 0; turn < kConeTurns && sum.color.a < 0.999; ++turn) {
    float level = clamp(log2(max(growth * t, 1.0)), 0.0, float(grid.levels - 1));
    float width = kConeStep * exp2(level);
    vec3 p = origin + (t + 0.5 * width) * direction;
    // Walls at the border of the grid are filtered with their repetition outside of it.
    if (any(lessThan(p, vec3(-width))) || any(greaterThan(p, grid.size + vec3(width)))) break;
    ConeSample s = sampleMips(grid, p, direction, level);
    // Surface that is already hidden adds nothing.
    float share = min(opaque * kConeStep, (1.0 - sum.color.a) / max(s.color.a, 1e-6));
    sum.color += share * s.color;
    sum.weight += share * s.weight;
    t += width;
  }
  return sum;
}

// How far above a surface its own voxels reach into the filter, in widths of the filter's cells: one cell for the
// filter and half a cell because the wall may stand anywhere in its cell. Cones start at this height above level
// 0, and their cells grow in this proportion to the height, so they never touch their own wall (or its back, if
// it is thin). Surfaces behind another wall leak through it by the same distance. Of the light in one half of a
// room, 10% arrive behind a thin wall with 1.5, 5% with 2, 3% with 3. In Sponza, where all walls are thin, the
// light that arrives after one reflection adds up to 1.4 times that of traced rays with 2, 1.2 times with 3 and
// 1.1 times with 6.
const float kOwnReach = 1.5;
const float kHeightPerCell = 3.0;

#ifdef CONE_GATHER
#include "records/hemisphere_rays.h"
#include "vpls/paraboloid.glsl"
#include "voxels/voxel_trace.glsl"

LARGE_TEXELS(vec4, radiance);

// What a cone brings back, W/(sr m^2): the light that it meets, and that of an environment map where nothing hides it.
// met: radiance times coverage, and coverage.
vec3 lightOf(vec4 met, vec3 direction) {
  vec3 light = met.rgb;
  if (hasEnvironmentMap() && met.a < 1.0)
    light += (1.0 - met.a) * environmentRadiance(direction);
  return light;
}

// Irradiance on a surface from its surroundings, W/m^2 (Eq. 3 of the paper; passes/README.md, radiance), with six cones
// over the hemisphere:
//   E = pi sum(L_i c_i) / sum(c_i),   c_i: cosine of the cone's axis.
// The near part of a cone, in which the mips cannot be told from the surface itself, is a ray through the voxels. It
// extends beyond the start of the filter up to where walls would be cut in half. position: world space, m; turn: angle
// of the six cones around the normal, so that neighbours do not all look in the same directions.
vec3 gatherHemisphere(VoxelGrid grid, vec3 position, vec3 normal, float turn) {
  MipGrid mips = mipGrid(grid);
  mat3 frame_ = orthonormalFrame(normal);
  float c = cos(turn), s = sin(turn);
  vec3 origin = (position - mips.origin) / mips.cell;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kHemisphereRays; ++i) {
    vec3 local = kHemisphereRay[i];
    vec3 direction = normalize(frame_ * vec3(c * local.x - s * local.y, s * local.x + c * local.y, local.z));
    float start = kOwnReach / local.z;
    VoxelHit hit = traceVoxels(grid, position, direction, normal, (start + 2.0 * kOwnReach) * mips.cell);
    vec4 met = hit.side != kNoSide ? vec4(texelOf(radiance, int(hit.side)).rgb, 1.0)
                                   : coneTrace(mips, origin, direction, start, local.z / kHeightPerCell).color;
    sum += local.z * lightOf(met, direction);
  }
  return kPi * sum / kHemisphereCosines;
}
#endif

#endif
