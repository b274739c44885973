// A part of the mean light under the lobe of each mirror: that of one ray. Define: RAY_PASSAGE as 1.
#include "rays/gather_cache.glsl"
#include "mirror.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

IMAGE(rgba32f, restrict, image2D, traced);
COUNTERS { uint mirrors, rays, gathered; } counters;

layout(push_constant) uniform Constants {
  uint bounces;
  uint frameIndex;
  uint part;   // number of this ray
  uint parts;  // number of rays
} constants;

// An estimate of the integral of D V cos times the radiance that arrives, by a visible normal of the microfacets; a:
// 1 / distance of what sends it, 0 if the ray goes into the surface, 1/m. out_: to the eye, in the frame `axes` of the
// mirror's normal; stream: of random numbers.
vec4 underLobe(Mirror m, mat3 axes, vec3 out_, vec2 u, uint stream) {
  vec3 h = sampleVisibleNormal(out_, m.alpha, u), in_ = 2.0 * dot(out_, h) * h - out_, direction = toWorld(axes, in_);
  if (in_.z <= 0.0 || dot(m.face, direction) <= 0.0) return vec4(0.0);
  float hidden = smithLambda(out_, m.alpha), weight = (1.0 + hidden) / (1.0 + hidden + smithLambda(in_, m.alpha));
  vec3 origin = m.position + (m.face - m.away) * rayEpsilon();
  TracedSurface hit = arrive(origin, direction, kFarAway);
  if (hit.triangle == kNoTriangle)
    return vec4(hasEnvironmentMap() ? weight * hit.brighter * environmentRadiance(direction) : vec3(0.0),
                1.0 / kOutside);
  float nearness = 1.0 / max(distance(hit.position, origin), kLeastReach);
  if (!hit.there) return vec4(vec3(0.0), nearness);
  vec3 light = seenLight(hit, -direction, m.roughness);
  light += reflectance(hit) * gatheredLight(hit, constants.bounces - 1u, stream, kMirrorCellWidth * m.distance_, 0.0);
  return vec4(weight * light, nearness);
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID);
  if (any(greaterThanEqual(block, imageSize(traced)))) return;
  Mirror m = mirrorAt(block);
  vec4 sum = constants.part > 0u ? imageLoad(traced, block) : vec4(0.0);
  if (m.there) {
    mat3 axes = orthonormalFrame(m.normal);
    vec3 out_ = toLocal(axes, -m.away);
    out_ = normalize(vec3(vec2(out_), max(out_.z, kLeastLobe)));  // a bent normal may face away from the eye
    uint stream = randomStream(frame.seed, uint(block.x), kMirrorStream, uint(block.y)),
         ray = constants.frameIndex + constants.part;
    vec4 seen = underLobe(m, axes, out_, streamSequence(stream, ray),
                          randomStream(stream, ray, kMirrorLightStream, 0u));
    float albedo = max(mirrorAlbedo(out_.z, m.roughness).all, kLeastLobe);
    sum += vec4(vec3(seen) / albedo, seen.a) / float(constants.parts);
    if (constants.part == 0u) atomicAdd(counters.mirrors, 1u);
    atomicAdd(counters.rays, rayCount);
    atomicAdd(counters.gathered, gatherCount);
  }
  imageStore(traced, block, sum);
}
