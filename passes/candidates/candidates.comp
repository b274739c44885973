// One attempt per invocation: a pixel of the region, the surface it shows, and one diffuse bounce from there. The
// voxel side hit by the bounce becomes a candidate; it need not be visible to the eye. INTERSECTION 1: it lies where
// the ray meets the side's plane, not at the side's average. TRACED 1: every fourth attempt first takes an eye path at
// random, and the candidate lies where that ends, with the light found there. Voxels know only direct light, none of
// emissive surfaces, and their averages close gaps that light comes through. EMITTED 1: no attempt starts at the eye;
// the candidates are VPLs of light paths.
#include "device/texels.glsl"
#include "scene/objects.glsl"
#include "vpls/paraboloid.glsl"
#include "sampling/diffuse_bounce.glsl"
#include "sampling/random.glsl"
#include "sampling/fovea.glsl"
#include "screen/gbuffer.glsl"
#include "voxels/voxel_trace.glsl"

layout(local_size_x = 64) in;

SURFACES(gbuffer, surfaceAt)
uniform texture2D gbufferNormal;
uniform texture2D gbufferFace;
#if TWO_EYES
SURFACES(gbuffer2, secondSurfaceAt)
uniform texture2D gbuffer2Normal;
uniform texture2D gbuffer2Face;
#endif
#if HAS_RADIANCE
LARGE_TEXELS(vec4, radiance);
#endif
#if TRACED
#include "vpls/eye_paths.glsl"
LARGE_TEXELS(vec4, tracedEnds);
#endif
#if EMITTED
uniform samplerBuffer emitted;
#endif
layout(std430) writeonly buffer Candidates { Candidate candidates[]; };
layout(std430) buffer Counters { uint counters[]; };  // in the order below

const uint kRays = 0u, kCandidates = 1u, kEscaped = 2u, kBackground = 3u;
// Keep the random numbers of this pass apart from others.
const uint kCandidateStream = 0x63616e64u, kPathStream = 0x63617074u;

layout(push_constant) uniform Push {
  vec2 secondGaze;
  float foveaRadius;
  uint region;
  uint imageShare64ths;
  uint seed;
  uint streamFrame;
  uint count;
};

struct Seen {  // the surface shown by a pixel
  vec3 position, normal, face;
  bool background;
};

Seen seenAt(ivec2 pixel, vec4 place, texture2D normal, texture2D face) {
  return Seen(place.xyz, texelFetch(normal, pixel, 0).xyz, octDecode(texelFetch(face, pixel, 0).xy), !(place.w > 0.0));
}

ivec2 pixelOf(ivec2 size, vec2 gaze, uint stream, uint from) {
  return regionSample(from, makeFovea(gaze, vec2(size), foveaRadius), size, stream);
}

#if TRACED || EMITTED
// The side of the voxel at `position` whose surface faces most as `normal` says.
uint sideAt(vec3 position, vec3 normal) {
  VoxelGrid grid = voxelsGrid();
  uint voxel = voxelAt(grid, ivec3(floor(worldToVoxel(grid, position)))), found = kNoSide;
  float best = 0.0;
  for (uint side = 2u * voxel - 2u; voxel > 0u && side < 2u * voxel; ++side) {
    VoxelSide s = loadSide(side);
    float cosine = dot(s.normal, normal);
    if (s.area > 0.0 && cosine > best) {
      best = cosine;
      found = side;
    }
  }
  return found;
}
#endif

// The candidate on a voxel side, at a place of its surface.
Candidate candidateOn(uint number, vec3 place) {
  VoxelSide side = loadSide(number);
  Candidate candidate = kNoCandidate;
  candidate.position = place;
  candidate.side = number;
  candidate.normal = side.normal;
  candidate.object = side.object;
  candidate.reflectance = side.reflectance;
#if HAS_RADIANCE
  candidate.luminance = texelOf(radiance, int(number)).w;
#endif
  uint object = uint(side.object);
  if (objectDeforms(object)) {  // its place on the surface does not change
    candidate.localPosition = attach(uint(side.triangle), place);
    candidate.position = attachedPosition(candidate.localPosition);
  } else {
    candidate.localPosition = toObject(object, place);
  }
  return candidate;
}

#if EMITTED
// The candidate at VPL i of the light paths, if there is one and its voxel has a side there.
Candidate candidateAtEmitted(uint i) {
  if (i >= uint(textureSize(emitted)) / 3u) return kNoCandidate;
  Vpl vpl = loadVpl(emitted, i);
  uint side = isLit(vpl) ? sideAt(vpl.position, vpl.normal) : kNoSide;
  if (side == kNoSide) return kNoCandidate;
  return candidateOn(side, INTERSECTION != 0 ? vpl.position : loadSide(side).position);
}
#endif

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
#if EMITTED
  Candidate candidate = candidateAtEmitted(i);
  candidates[i] = candidate;
  if (candidate.side != kNoSide) atomicAdd(counters[kCandidates], 1u);
#else
  Candidate candidate = kNoCandidate;
  uint stream = randomStream(seed, streamFrame, kCandidateStream, i);
#if TRACED
  if (i % 4u == 3u) {
    uint paths = uint(texelsIn(tracedEnds)) / 3u, path = randomStream(seed, streamFrame, kPathStream, i) % paths;
    EyePathEnd end = loadEyePathEnd(tracedEnds, path);
    uint side = end.kind > 0.0 ? sideAt(end.position, end.normal) : kNoSide;
    if (side != kNoSide) {
      candidate = candidateOn(side, end.position);
      candidate.luminance = end.weight * luminanceOf(end.radiance);
      candidates[i] = candidate;
      atomicAdd(counters[kCandidates], 1u);
      return;
    }
  }
#endif
  uint number, from = regionOf(region, imageShare64ths, TWO_EYES != 0 ? i / 2u : i, number);
  ivec2 pixel = pixelOf(imageSize(gbufferDistance), view.gaze, stream, from);
  Seen seen = seenAt(pixel, surfaceAt(pixel), gbufferNormal, gbufferFace);
#if TWO_EYES
  if ((i & 1u) == 1u) {
    pixel = pixelOf(imageSize(gbuffer2Distance), secondGaze, stream, from);
    seen = seenAt(pixel, secondSurfaceAt(pixel), gbuffer2Normal, gbuffer2Face);
  }
#endif
  if (seen.background) {
    atomicAdd(counters[kBackground], 1u);
    candidates[i] = candidate;
    return;
  }
  vec3 direction = diffuseBounce(normalize(seen.normal), seen.face, streamPoint(stream, kRegionDraws));
  VoxelHit hit = traceVoxels(voxelsGrid(), seen.position, direction, seen.face);
  atomicAdd(counters[kRays], 1u);
  if (hit.side == kNoSide) {
    atomicAdd(counters[kEscaped], 1u);
    candidates[i] = candidate;
    return;
  }
  atomicAdd(counters[kCandidates], 1u);
  candidates[i] = candidateOn(
      hit.side, INTERSECTION != 0 ? seen.position + hit.distance * direction : loadSide(hit.side).position);
#endif
}
