// Cone tracing through the bundle "voxel-mips" (pass mipmap), and the light that arrives over a hemisphere.
// Needs common/scene.glsl and an input port `mips` (Usage::Sampled). Shaders that want the weights along with the light
// define CONE_WEIGHT. gatherHemisphere needs the input ports of common/voxel_trace.glsl and a texel buffer `radiance`
// besides, and CONE_GATHER to be defined.
#ifndef FOVEA_CONE_GLSL
#define FOVEA_CONE_GLSL

#include "common/voxel.glsl"

uniform texture3D mipsColor;
#ifdef CONE_WEIGHT
uniform texture3D mipsWeight;
#endif
uniform sampler linearClamp;

// Level l holds `size` / 2^l cells a side; positions count in cells of level 0, which are two voxels wide.
struct MipGrid {
  vec3 origin;   // world space, m
  float cell;    // of level 0, m
  int size;
  int levels;    // that are halves of each other: all, where the size is a power of two
  bool faces;    // six faces side by side in x, else one volume
};

MipGrid mipGrid(VoxelGrid grid) {
  ivec3 size = textureSize(mipsColor, 0);
  return MipGrid(grid.origin, 2.0 * grid.cell, size.y, findLSB(size.y) + 1, size.x > size.y);
}

// Surface is kept as coverage: area (projected on the face, where there are faces) by the area of a cell's face. It adds up
// along a ray by sum(coverage * step / cell), which comes to 1 where the ray has crossed one surface, whatever the
// angle: for projected areas because the coverage towards direction w is sum(|w_k| face_k). Multiplying transparencies instead would
// let a seventh of the light through a solid wall, since filtering spreads the wall over two cells.
// rgb: radiance times coverage; a: coverage, which exceeds 1 where a cell holds several surfaces.
struct ConeSample {
  vec4 color;
  float weight;  // likewise times the coverage; 0 without CONE_WEIGHT
};

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

// What faces `direction` around p (cells of level 0), between the levels.
ConeSample sampleMips(MipGrid grid, vec3 p, vec3 direction, float level) {
  float size = float(grid.size);
  float half_ = 0.5 * exp2(ceil(level)) / size;
  vec3 at = clamp(p / size, half_, 1.0 - half_);  // filtering must not reach into the next face
  if (!grid.faces) return mipFetch(at, 0.0, 1.0, level);
  // Faces +x -x +y -y +z -z by the way a surface looks: a direction to the right meets what looks to the left.
  vec3 towards = abs(direction);
  vec3 face = vec3(0.0, 2.0, 4.0) + vec3(greaterThan(direction, vec3(0.0)));
  ConeSample x = mipFetch(at, face.x, 6.0, level), y = mipFetch(at, face.y, 6.0, level),
             z = mipFetch(at, face.z, 6.0, level);
  return ConeSample(towards.x * x.color + towards.y * y.color + towards.z * z.color,
                    dot(towards, vec3(x.weight, y.weight, z.weight)));
}

const float kConeStep = 0.5;  // cells of the level
const int kConeTurns = 512;

// Front-to-back along a cone. origin, start: cells of level 0; growth: width of the filter's cells by the distance. The
// filter has to widen smoothly: where it jumps from one level to the next in front of a wall, the part of the wall that the fine
// level has not shown yet and the coarse one no longer shows is lost.
// Returns radiance and weight premultiplied with the coverage that was met, at most 1.
ConeSample coneTrace(MipGrid grid, vec3 origin, vec3 direction, float start, float growth) {
  ConeSample sum = ConeSample(vec4(0.0), 0.0);
  float t = start;
  // A wall may stand half a cell behind the middle of its cell: by then the filter has become wider by this much, and what the
  // wall adds up to smaller. A whole wall must hide all, so coverage counts that much more.
  float opaque = 1.0 + 0.5 * growth;
  for (int turn = 0; turn < kConeTurns && sum.color.a < 0.999; ++turn) {
    float level = clamp(log2(max(growth * t, 1.0)), 0.0, float(grid.levels - 1));
    float width = kConeStep * exp2(level);
    vec3 p = origin + (t + 0.5 * width) * direction;
    // Walls at the rim of the grid are filtered with what they repeat outside of it.
    if (any(lessThan(p, vec3(-width))) || any(greaterThan(p, grid.size + vec3(width)))) break;
    ConeSample s = sampleMips(grid, p, direction, level);
    // What is already hidden adds nothing.
    float share = min(opaque * kConeStep, (1.0 - sum.color.a) / max(s.color.a, 1e-6));
    sum.color += share * s.color;
    sum.weight += share * s.weight;
    t += width;
  }
  return sum;
}

// How far above a surface its own voxels reach into the filter, in widths of its cells: one cell of filter and half a cell
// because the wall stands anywhere in its cell. Cones start where they have risen that far above level 0, and their
// cells grow to this part of the height: they stay clear of the own wall (its back, if it is thin) for ever. What is
// behind another wall still reaches through it by as much: of the light in one half of a room, 10% arrive behind a thin wall with
// 1.5, 5% with 2, 3% with 3. In Sponza, where all walls are thin, the sum of the light that arrives after one reflection
// is 1.4 times that of traced rays with 2, 1.2 times with 3, 1.1 times with 6.
const float kOwnReach = 1.5;
const float kHeightPerCell = 3.0;

#ifdef CONE_GATHER
#include "common/hemisphere_rays.glsl"
#include "common/paraboloid.glsl"
#include "common/voxel_trace.glsl"

uniform samplerBuffer radiance;

// Irradiance on a surface from all that surrounds it (METHOD 2, radiance): six cones over the hemisphere,
//   E = pi sum(L_i c_i) / sum(c_i),   c_i: cosine of the cone's axis.
// The near part of a cone, that the mips cannot tell from the own surface, is a ray through the voxels; it reaches as far past the
// start of the filter as walls there would be cut in half. turn: angle of the six around the normal, so that
// neighbours do not all look the same way.
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
    sum += local.z * (hit.side != kNoSide ? texelFetch(radiance, int(hit.side)).rgb
                                          : coneTrace(mips, origin, direction, start, local.z / kHeightPerCell).color.rgb);
  }
  return kPi * sum / kHemisphereCosines;
}
#endif

#endif
