#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Bias compensation (Novak et al., "Screen-space bias compensation for interactive high-quality global illumination with
// virtual point lights", I3D 2011) by rays through the voxels: a VPL shaded as a disc of area A sends the part
//   A / (pi d^2 + A)
// of its light less to what is at a distance d than the point it stands for would. Cosine-weighted rays bring that part of the
// light they meet: one a pixel in the fovea, elsewhere one for four pixels. Those of neighbours are stratified, and pass
// deferred filters them along with the VPLs. An invocation has 2 x 2 pixels.
//
// Few rays that meet something bright would show as sparks, which no filter that small takes away: none brings more than
// `most` times the mean of its work group.
#include "common/scene.glsl"
#include "common/paraboloid.glsl"
#include "common/diffuse_bounce.glsl"
#include "common/fovea.glsl"
#include "common/voxel_trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, rgba32f) uniform readonly image2D gbufferPosition;
layout(set = 0, rgba16f) uniform readonly image2D gbufferNormal;
layout(set = 0, rg16_snorm) uniform readonly image2D gbufferFace;
layout(set = 0) uniform samplerBuffer radiance;
layout(set = 0) uniform samplerBuffer spread;  // x: area, m^2
layout(set = 0, rgba16f) uniform writeonly image2D irradiance;

layout(push_constant) uniform Constants {
  float foveaRadius;  // image widths
  float reach;        // radii of the disc
  float most;         // 0: no limit
};

shared float subgroupSums[64];

const uint kNearStream = 0x6e656172u;

// Its own part of the unit square for each of `side` x `side` neighbours, side 4 or 2.
vec2 stratified(uvec2 at, uint side) {
  uint bits = randomStream(side, kNearStream, at.x, at.y);
  uvec2 place = at & (side - 1u);
  vec2 within = vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)));
  return (vec2(place.x, (place.y + 2u * place.x + (place.x >> 1u)) & (side - 1u)) + within) / float(side);
}

vec3 lightAt(ivec2 pixel, vec2 u, float radius2) {
  vec4 position = imageLoad(gbufferPosition, pixel);
  if (!(position.w > 0.0)) return vec3(0.0);
  vec3 normal = normalize(imageLoad(gbufferNormal, pixel).xyz), face = octDecode(imageLoad(gbufferFace, pixel).xy);
  VoxelHit hit = traceVoxels(voxelsGrid(), position.xyz, diffuseBounce(normal, face, u), face, reach * sqrt(radius2));
  if (hit.side == kNoSide) return vec3(0.0);
  return min(texelFetch(radiance, int(hit.side)).rgb * (radius2 / (hit.distance * hit.distance + radius2)), 65504.0);
}

// Whether any pixel of this work group lies in the fovea: then all of them get a ray of their own.
bool groupInFovea(ivec2 size) {
  Fovea fovea = makeFovea(view.gaze.xy, vec2(size), foveaRadius);
  vec2 low = vec2(2u * gl_WorkGroupID.xy * gl_WorkGroupSize.xy), high = low + vec2(2u * gl_WorkGroupSize.xy);
  return distance(clamp(fovea.centre, low, high), fovea.centre) <= fovea.radius;
}

float luminanceOf(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

// Mean over the work group, by a sum that is the same in every run.
float groupMean(float sum, float rays) {
  sum = subgroupAdd(sum);
  if (subgroupElect()) subgroupSums[gl_SubgroupID] = sum;
  barrier();
  float total = 0.0;
  for (uint i = 0u; i < gl_NumSubgroups; ++i) total += subgroupSums[i];
  return total / (rays * float(gl_WorkGroupSize.x * gl_WorkGroupSize.y));
}

void main() {
  ivec2 size = imageSize(irradiance), corner = 2 * ivec2(gl_GlobalInvocationID.xy);
  float area = texelFetch(spread, 0).x, radius2 = area / kPi;
  bool each = groupInFovea(size);
  int rays = each ? 4 : 1;
  vec3 lights[4];
  float sum = 0.0;
  // As a loop, for a CPU device walks through a branch that no lane takes.
  for (int ray = 0; ray < rays; ++ray) {
    ivec2 pixel = corner + ivec2(ray & 1, ray >> 1);
    vec2 u = each ? stratified(uvec2(pixel), 4u) : stratified(gl_GlobalInvocationID.xy, 2u);
    lights[ray] = area > 0.0 ? lightAt(min(pixel, size - 1), u, radius2) : vec3(0.0);
    sum += luminanceOf(lights[ray]);
  }
  float limit = most > 0.0 ? most * groupMean(sum, float(rays)) : 1e30;
  for (int ray = 0; ray < rays; ++ray) {
    vec3 light = lights[ray] * min(limit / max(luminanceOf(lights[ray]), 1e-30), 1.0);
    for (int k = 0; k < (each ? 1 : 4); ++k) {
      ivec2 to = each ? corner + ivec2(ray & 1, ray >> 1) : corner + ivec2(k & 1, k >> 1);
      if (all(lessThan(to, size))) imageStore(irradiance, to, vec4(light, 0.0));
    }
  }
}
