// The sample of each pixel: what a ray meets, and the light that leaves from there. Where there are emissive surfaces
// or an environment map, each path has a second ray that is aimed at these. One of all rays of a pixel is chosen by
// resampling, weighted by the balance heuristic (Veach and Guibas 1995). Define: RAY_PASSAGE 0/1 (rays/trace.glsl).
#include "screen/blocks.glsl"
#include "sampling/fovea.glsl"
#include "rays/gather.glsl"
#include "records/reservoir.h"

layout(local_size_x = 8, local_size_y = 8) in;

LIST(writeonly, Reservoir, reservoirs);
COUNTERS { uint rays, samples; } counters;

layout(push_constant) uniform Constants {
  uint depth;
  uint spacing;
  uint outsideSpacing;
  float foveaRadius;
  uint paths;
  uint frameIndex;
} constants;

CONSTANT Reservoir kNothing = Reservoir(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

struct Choice {
  WeightedChoice among;
  Reservoir chosen;
  float density;  // with which the rays of a path go there, per sr
};

// Light that leaves a surface by paths of at most `depth` edges to the eye, of which two are known.
vec3 radianceOf(TracedSurface hit, uint stream) {
  vec3 rho = reflectance(hit);
  return emitted(hit) + diffuseLight(hit, rho) + rho * gather(hit, constants.depth - 3u, 1u, stream);
}

// aimedAt: the triangle at which the ray is aimed, if it is. A ray that meets something else instead does not count.
void consider(INOUT(Choice) choice, TracedSurface v, vec3 direction, bool isAimed, uint aimedAt, uint stream) {
  float cosine = dot(v.normal, direction);
  if (cosine <= 0.0 || dot(v.face, direction) <= 0.0) return;
  TracedSurface hit = arrive(v.origin, direction, kFarAway);
  if (isAimed && hit.triangle != aimedAt) return;
  Reservoir found = kNothing;
  float density = cosine / kPi;
  if (hit.triangle == kNoTriangle) {
    EmitterRay outside = rayOutside(v, direction);
    found = Reservoir(v.position + kSky * direction, 0.0, hit.brighter * outside.radiance, 0.0, -direction, 0.0);
    density += outside.density;
  } else if (hit.there) {
    bool moves = hit.triangle >= frame.firstMovingTriangle;
    float mover = moves ? float(hit.triangle - frame.firstMovingTriangle + 1u) : 0.0;
    found = Reservoir(hit.position, 0.0, radianceOf(hit, stream), 0.0, hit.face, mover);
    density += aimedDensity(v, hit);
  }
  float target = dot(found.radiance, kLuminance) * cosine;
  if (!(target > 0.0) || !takes(choice.among, target / density)) return;
  choice.chosen = found;
  choice.density = density;
}

Reservoir sampleAt(uvec2 pixel) {
  TracedSurface v = look(vec2(pixel) + 0.5);
  if (!v.there) return kNothing;
  uint stream = randomStream(frame.seed, pixel.x, kGiSampleStream, pixel.y);
  WeightedChoice among =
      WeightedChoice(uniformFloat(randomStream(stream, constants.frameIndex, kGiChoiceStream, 0u)), 0.0, 0.0);
  Choice choice = Choice(among, kNothing, 1.0);
  // Every second ray is the aimed one.
  for (uint i = 0u; i < 2u * constants.paths; ++i) {
    bool isAimed = (i & 1u) != 0u;
    if (isAimed && !hasEmitters()) continue;
    uint path = constants.frameIndex * constants.paths + i / 2u,
         gatherStream = randomStream(stream, path, kGiGatherStream, 0u);
    EmitterRay ray = kNoEmitterRay;
    if (isAimed) ray = aimedRay(v, randomStream(stream, path, kGiAimStream, 0u));
    else ray.direction = cosineDirection(v.normal, streamSequence(stream, path));
    if (isAimed && !ray.there) continue;
    consider(choice, v, ray.direction, isAimed, ray.triangle, isAimed ? hashCombine(gatherStream, 1u) : gatherStream);
  }
  choice.chosen.count = 1.0;
  if (isAnyChosen(choice.among))
    choice.chosen.weight = inverseProbability(choice.among) / (choice.density * float(constants.paths));
  return choice.chosen;
}

void main() {
  uvec2 pixel = uvec2(gl_GlobalInvocationID), size = viewSize();
  if (any(greaterThanEqual(pixel, size))) return;
  Fovea fovea = makeFovea(view.gaze, view.size, constants.foveaRadius);
  bool seen = distance(vec2(pixel) + 0.5, fovea.centre) <= fovea.radius;
  uint width = seen ? constants.spacing : max(constants.spacing, constants.outsideSpacing);
  uvec2 block = pixel / width;
  Reservoir found = kNothing;
  if (pixel == width * block + samplePixel(constants.frameIndex, width, block)) {
    found = sampleAt(pixel);
    atomicAdd(counters.rays, rayCount);
    if (found.count > 0.0) atomicAdd(counters.samples, 1u);
  }
  reservoirs.list[pixel.y * size.x + pixel.x] = found;
}
