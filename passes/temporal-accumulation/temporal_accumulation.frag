// Running mean at every pixel of samples that some or all pixels get in a frame. A pixel takes over the previous
// frame's mean from where its surface was then, and adds its own sample, or that of its block if it was taken on the
// same surface. Defines: BLOCKS 0/1, 1 if a texel of `samples` stands for several pixels; CHANGES 0/1, 1 if `change`
// says by how much light has changed; GLOSS 0/1, 1 if there is other light at the same pixels.
#include "device/half.glsl"
#include "screen/lattice.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"

// Images rather than textures, which cost several times as much on a CPU device.
SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(r32ui) uniform readonly uimage2D origin;
layout(rgba16f) uniform readonly image2D samples;
layout(rgba16f) uniform readonly image2D history;
#if CHANGES
uniform samplerBuffer change;  // y: ageing, z: share of the history that is lost
#endif
layout(location = 0) out vec4 mean;

// What a mean is formed of.
#if GLOSS
layout(rgba16f) uniform readonly image2D gloss;
layout(rgba16f) uniform readonly image2D glossHistory;
layout(location = 1) out vec4 glossMean;
#define Light mat2x3
Light withGloss(vec3 light, ivec2 texel) { return mat2x3(light, imageLoad(gloss, texel).rgb); }
#else
#define Light vec3
Light withGloss(vec3 light, ivec2 texel) { return light; }
#endif

layout(push_constant) uniform Constants {
  float frames;          // length of the mean
#if BLOCKS
  float planeTolerance;  // relative to the distance from the eye
  float leastCos;
  int shift;             // a texel of `samples` is 2^shift pixels wide
  float rays;            // of a sample, as long as no history is lost
  float changedRays;     // of a sample if all history is lost
  float wideRays;        // of a sample whose block is wider than a texel
  float jumped;          // share of the history that is lost by a jump of the gaze
  uint frameIndex;
#else
  float weight;          // of a sample
  float mostOfOthers;    // frames that the history of another estimate may count
#endif
};

const uint kNone = 0xffffffffu;

#if CHANGES
float ageing() { return texelFetch(change, 0).y; }
float lost() { return texelFetch(change, 0).z; }
#else
float ageing() { return 0.0; }
float lost() { return 0.0; }
#endif

struct Mean {
  Light light;
  float count;  // of rays that it is worth, or of samples for single pixels; 0 if there is none
  bool wide;    // whether the last one was for a wide block
};

Mean fromHistory(ivec2 p) {
  uint from = imageLoad(origin, p).r;
  ivec2 at = ivec2(from & 0xffffu, from >> 16);
  vec4 old = from == kNone ? vec4(0.0) : imageLoad(history, at);
#if GLOSS
  Light light = mat2x3(old.rgb, from == kNone ? vec3(0.0) : imageLoad(glossHistory, at).rgb);
#else
  Light light = old.rgb;
#endif
  float count = abs(old.a);
  return Mean(light, count / (1.0 + count * ageing()), old.a < 0.0);
}

Light mixed(Light a, Light b, float share) {
#if GLOSS
  return mat2x3(mix(a[0], b[0], share), mix(a[1], b[1], share));
#else
  return mix(a, b, share);
#endif
}

void store(Mean result) {
  float count = result.wide ? -result.count : result.count;
#if GLOSS
  glossMean = vec4(nearestHalf(result.light[1]), count);
  mean = vec4(nearestHalf(result.light[0]), count);
#else
  mean = vec4(nearestHalf(result.light), count);
#endif
}

#if BLOCKS
struct Sample {
  Light value;
  int side;     // width of its block
  bool found;   // whether there is a sample
  bool wanted;  // whether the block's surface asks for samples at all
  bool own;     // whether it lies on the pixel's surface
};

bool isWide(int side) { return side >> shift > 1; }

// The sample of a pixel. Its code, as pass near-field makes it: bits 0-3 width of its block, 4-6 and 7-9 place of its
// pixel in the block, 10 if there is none. Divisions are avoided, as a CPU device executes them one lane at a time.
Sample sampleAt(ivec2 p, vec4 position, vec3 normal, ivec2 size) {
  ivec2 inside = clamp(p, ivec2(0), size - 1);
  vec4 value = imageLoad(samples, inside >> shift);
  int code = int(abs(value.a)), side = max(code & 15, 1);
  bool found = p == inside && code >> 10 == 0;
  ivec2 offset = ivec2(latticeOffset(frameIndex, uint(side))), corner = ((inside + offset) & -side) - offset;
  ivec2 from = clamp(corner + ivec2(code >> 4 & 7, code >> 7 & 7), ivec2(0), size - 1);
  bool own = found && sameSurface(position.xyz, normal, normal, surfaceAt(from),
                                  imageLoad(gbufferNormal, from).xyz, planeTolerance * position.w, leastCos);
  return Sample(withGloss(value.rgb, inside >> shift), side, found, value.a >= 0.0, own);
}

float luminanceOf(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }
float luminanceOf(mat2x3 light) { return luminanceOf(light[0] + light[1]); }

// Sum of samples, their number, and the brightest one.
struct Around {
  Light sum;
  float count;
  Light brightest;
};

void add(inout Around around, Sample s, bool wanted) {
  if (!wanted) return;
  around.sum += s.value;
  around.count += 1.0;
  if (luminanceOf(s.value) > luminanceOf(around.brightest)) around.brightest = s.value;
}

// Mean of single rays without the brightest, if there are others: one that hits something sunlit would be a firefly.
// Samples that are means of several rays would lose light that way, and need it less.
Light robustMean(Around around, float raysOfSample) {
  bool dropped = raysOfSample < 2.0 && around.count > 1.0;
  return (around.sum - around.brightest * float(dropped)) / max(around.count - float(dropped), 1.0);
}

// Initial value where there is no mean yet: the mean of the samples on the pixel's surface in the surrounding blocks
// of the same width; narrower ones lie where light changes quickly. If there are none, samples of other surfaces are
// used, but with no weight.
Mean fromAround(ivec2 p, vec4 position, vec3 normal, ivec2 size, int side, float raysOfSample) {
  Around own = Around(Light(0.0), 0.0, Light(0.0)), all = own;
  for (int i = 0; i < 9; ++i) {
    Sample s = sampleAt(p + max(side, 1 << shift) * (ivec2(i % 3, i / 3) - 1), position, normal, size);
    add(own, s, s.own && s.side == side);
    add(all, s, s.found);
  }
  Mean result = Mean(robustMean(own, raysOfSample), own.count * raysOfSample, isWide(side));
  if (own.count == 0.0) result.light = robustMean(all, raysOfSample);
  return result;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = imageSize(gbufferDistance);
  vec4 position = surfaceAt(p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  bool surface = position.w > 0.0;
  Mean old = fromHistory(p);
  Sample s = sampleAt(p, position, normal, size);
  bool wide = isWide(s.side);
  float allLost = max(jumped, lost());
  float its = wide ? wideRays : round(mix(rays, changedRays, allLost));
  // All pixels of a larger block change at once, so they change less each time. Where history is
  // lost, the mean is as short as that of single rays: outdated light is then a larger error than their noise.
  float most = frames * (wide ? float(s.side >> shift) : mix(rays, 1.0, allLost));
  // Where the gaze has jumped, each ray of the history of wide blocks stands for many narrow ones.
  if (!wide && its > rays && old.wide && old.count > frames) old.count = frames * frames / old.count;
  float count = s.own ? min(old.count + its, most) : old.count;
  Mean result = Mean(old.light, count, s.own ? wide : old.wide);
  if (s.own) result.light = mixed(old.light, s.value, min(its / count, 1.0));
  if (surface && s.wanted && !(old.count > 0.0)) result = fromAround(p, position, normal, size, s.side, its);
  if (!surface) result = Mean(Light(0.0), 0.0, false);
  store(result);
}
#else
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  Mean old = fromHistory(p);
  vec4 its = imageLoad(samples, p);  // a: by how many times the mean is longer than `frames`, if above 1
  // After a jump of the gaze, what comes from a mean that was not longer is another estimate, and a worse one.
  if (its.a > 1.0 && old.count <= frames) old.count = min(old.count, mostOfOthers);
  float count = min(old.count + weight, frames * max(its.a, 1.0));
  store(Mean(mixed(old.light, withGloss(its.rgb, p), min(weight / count, 1.0)), count, false));
}
#endif
