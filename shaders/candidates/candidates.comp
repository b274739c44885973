// One attempt per invocation: a pixel of the region, the surface it shows, and one diffuse bounce from there. The
// voxel side hit by the bounce becomes a candidate; it need not be visible to the eye.
#include "common/scene.glsl"
#include "common/paraboloid.glsl"
#include "common/diffuse_bounce.glsl"
#include "common/random.glsl"
#include "common/fovea.glsl"
#include "common/voxel_trace.glsl"

layout(local_size_x = 64) in;

uniform texture2D gbufferPosition;
uniform texture2D gbufferNormal;
uniform texture2D gbufferFace;
#if TWO_EYES
uniform texture2D gbuffer2Position;
uniform texture2D gbuffer2Normal;
uniform texture2D gbuffer2Face;
#endif
#if HAS_RADIANCE
uniform samplerBuffer radiance;
#endif
layout(std430) writeonly buffer Candidates { Candidate candidates[]; };
layout(std430) buffer Counters { uint counters[]; };  // in the order below

const uint kRays = 0u, kCandidates = 1u, kEscaped = 2u, kBackground = 3u;
const uint kCandidateStream = 0x63616e64u;  // keeps the random numbers of this pass apart from others

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

Seen seenAt(texture2D position, texture2D normal, texture2D face, vec2 gaze, uint stream, uint from) {
  ivec2 size = textureSize(position, 0);
  ivec2 pixel = regionSample(from, makeFovea(gaze, vec2(size), foveaRadius), size, stream);
  vec4 place = texelFetch(position, pixel, 0);
  return Seen(place.xyz, texelFetch(normal, pixel, 0).xyz, octDecode(texelFetch(face, pixel, 0).xy), !(place.w > 0.0));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Candidate candidate = kNoCandidate;
  uint stream = randomStream(seed, streamFrame, kCandidateStream, i);
  uint number, from = regionOf(region, imageShare64ths, TWO_EYES != 0 ? i / 2u : i, number);
#if TWO_EYES
  Seen seen;
  if ((i & 1u) == 0u)
    seen = seenAt(gbufferPosition, gbufferNormal, gbufferFace, view.gaze, stream, from);
  else
    seen = seenAt(gbuffer2Position, gbuffer2Normal, gbuffer2Face, secondGaze, stream, from);
#else
  Seen seen = seenAt(gbufferPosition, gbufferNormal, gbufferFace, view.gaze, stream, from);
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
  VoxelSide side = loadSide(hit.side);
  candidate.position = side.position;
  candidate.side = hit.side;
  candidate.normal = side.normal;
  candidate.object = side.object;
  candidate.reflectance = side.reflectance;
#if HAS_RADIANCE
  candidate.luminance = texelFetch(radiance, int(hit.side)).w;
#endif
  uint object = uint(side.object);
  if (objectDeforms(object)) {  // its place on the surface does not change
    candidate.localPosition = attach(uint(side.triangle), side.position);
    candidate.position = attachedPosition(candidate.localPosition);
  } else {
    candidate.localPosition = toObject(object, side.position);
  }
  candidates[i] = candidate;
}
