// Light from nearby surfaces at one point: the part of it that VPLs leave out whose kernel is a disc (passes/README.md,
// near-field).
//
// Define: RAY_PASSAGE (rays/trace.glsl); MAP_ALONE 0/1, 1 if only the light of the environment map is found.
//
// Needs the functions that it declares, defined by whoever includes it.
#include "rays/gather.glsl"
#include "records/near_field.h"

// discArea(): how large the discs of VPLs are, m^2; if 0, rays find out their length and no light. reach(): rays go so
// far with a probability of this many times the part of the light that discs leave out there. noteLength(): takes
// the length of a ray, m, and the probability of going so far. furtherLight(): what gather() would find at v, W/(sr
// m^2). underLobe(): what light from a direction, which is unit, adds to the mean of the light under the lobe of the
// surface for each unit of irradiance / pi that it adds; cosine: by which that irradiance counts.
DECLARE(float discArea());
DECLARE(float reach());
DECLARE(void noteLength(float distance_, float probability));
DECLARE(vec3 furtherLight(TracedSurface v, uint bounces, uint stream));
DECLARE(float underLobe(vec3 direction, float cosine));

// Light that arrives, W/(sr m^2): irradiance / pi, and the mean under the lobe of the surface.
struct NearLight {
  vec3 light, gloss;
};

// Adds irradiance / pi from one direction, which is unit.
void add(INOUT(NearLight) sum, TracedSurface v, vec3 light, vec3 direction) {
  sum.light += light;
  sum.gloss += underLobe(direction, dot(v.normal, direction)) * light;
}

uint shadedCount = 0u;  // rays at whose ends this invocation has evaluated the light

// Squared radius of a disc, m^2; the part of the light from a distance, m, that discs leave out; and the probability
// with which a cosine-weighted ray goes so far.
float discRadius2() { return discArea() / kPi; }
float partAt(float distance_) { return discRadius2() / (distance_ * distance_ + discRadius2()); }
float probabilityAt(float distance_) { return min(reach() * partAt(distance_), 1.0); }

// The light along an aimed ray, divided by the densities of all ways to choose it (balance heuristic). Beside the
// `points` on surfaces, a cosine-weighted ray counts once, and in the environment as much again as all cosine-weighted
// points together.
vec3 sharedLight(TracedSurface v, EmitterRay to, uint points) {
  if (!to.there) return vec3(0.0);
  float cosine = cosineDensity(v, to.direction);
  float cosineWeighted = to.triangle == kNoTriangle ? 2.0 : probabilityAt(to.distance_) / float(points);
  return to.radiance * (cosine / (cosine * cosineWeighted + to.density));
}

// Adds the part of one ray aimed at emissive surfaces or at the environment map. It is aimed at one of `points` points,
// chosen by the light that they would send without occlusion (Talbot et al., "Importance Resampling for Global
// Illumination", EGSR 2005). The points share out the emitters, and those of consecutive samples (`index`) follow
// low-discrepancy sequences.
void addPoints(INOUT(NearLight) sum, TracedSurface v, uint points, uint stream, uint index) {
  float place = uniformFloat(hashCombine(stream, 0u) + index * kGoldenRatio);
  WeightedChoice choice = WeightedChoice(uniformFloat(hashCombine(stream, 1u) + index * kSilverRatio), 0.0, 0.0);
  EmitterRay chosen = kNoEmitterRay;
  vec3 light = vec3(0.0);
  for (uint i = 0u; i < (hasEnvironmentMap() ? 2u * points : points); ++i) {
    vec2 u = streamSequence(hashCombine(stream, i + 2u), index);
    EmitterRay to;
    if (i < points) to = aimedRay(v, vec3((float(i) + place) / float(points), u));
    else to = rayOutside(v, cosineDirection(v.normal, u));
#if MAP_ALONE
    if (to.triangle != kNoTriangle) continue;
#endif
    vec3 its = sharedLight(v, to, points) / float(points);
    float part = its.r + its.g + its.b;
    if (!(part > 0.0) || !takes(choice, part)) continue;
    chosen = to;
    light = its;
  }
  if (isAnyChosen(choice)) add(sum, v, light * visibleShare(v, chosen) * inverseProbability(choice), chosen.direction);
}

// The light at v by one cosine-weighted ray and one aimed ray. block: the block of pixels that v stands for, as
// adjacent ones, 4 x 4 of them, share one sequence; turn_: number of the sample; bounces: most reflections, at least 1;
// points: as in addPoints().
NearLight nearLight(TracedSurface v, uvec2 block, uint turn_, uint bounces, uint points) {
  uvec2 group = block / 4u, place = block % 4u;
  uint order = (place.x & 1u) << 3 | (place.y & 1u) << 2 | (place.x & 2u) | place.y >> 1;
  uint stream = randomStream(frame.seed, group.x, kNearStream, group.y);
  vec3 direction = cosineDirection(v.normal, streamSequence(stream, 16u * turn_ + order));
  // Rays are traced only as far as they contribute: beyond that, a hit is worth no more than a miss.
  float choice = max(uniformFloat(randomStream(stream, turn_, kChoiceStream, order)), 1e-6), radius2 = discRadius2();
  float farthest = radius2 > 0.0 ? sqrt(radius2 * max(reach() / choice - 1.0, 0.0)) : kFarAway;
  NearLight sum = NearLight(vec3(0.0), vec3(0.0));
  if (hasEmitters() && radius2 > 0.0)
    addPoints(sum, v, points, hashCombine(stream, kNearAimStream), 16u * turn_ + order);
  if (dot(direction, v.face) <= 0.0) return sum;
  bool tracesOutside = hasEnvironmentMap() && radius2 > 0.0;
  TracedSurface hit = arrive(v.origin, direction, tracesOutside ? kFarAway : farthest);
  if (tracesOutside && hit.triangle == kNoTriangle) {
    add(sum, v, hit.brighter * sharedLight(v, rayOutside(v, direction), points), direction);
    return sum;
  }
#if !MAP_ALONE
  float distance_ = distance(hit.position, v.position);
  if (!hit.there || (tracesOutside && distance_ > farthest)) return sum;
  float probability = radius2 > 0.0 ? probabilityAt(distance_) : 1.0;
  noteLength(distance_, probability);
  if (!(radius2 > 0.0)) return sum;
  ++shadedCount;
  vec3 rho = reflectance(hit), emission = emitted(hit);
  vec3 radiance = directTowards(hit, -direction, rho, kBounceRoughness);
  radiance += rho * furtherLight(hit, bounces - 1u, randomStream(stream, turn_, kNearGatherStream, order));
  if (emission != vec3(0.0)) {
    float cosine = cosineDensity(v, direction);
    add(sum, v, emission * (cosine / (cosine * probability + float(points) * aimedDensity(v, hit))), direction);
  }
  add(sum, v, radiance * (partAt(distance_) / probability), direction);
#endif
  return sum;
}
