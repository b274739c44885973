// The light that reaches a surface from emissive surfaces and from the environment map, and after reflection by other
// surfaces: paths with next event estimation at every vertex and multiple importance sampling (Veach and Guibas,
// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995).
//
// Define: RAY_PASSAGE (rays/trace.glsl).
#ifndef FOVEA_RAYS_GATHER_GLSL
#define FOVEA_RAYS_GATHER_GLSL

#include "rays/reflection.glsl"

// A ray from a surface to a point on an emissive surface, or to the environment map.
struct EmitterRay {
  bool there;       // whether a point was found that faces the surface; it may be occluded
  vec3 direction;   // unit
  float distance_;  // m; kFarAway to the environment
  float density;    // probability density of the direction, per sr
  uint triangle;    // kNoTriangle in the environment
  vec3 radiance;    // W/(sr m^2)
};

CONSTANT EmitterRay kNoEmitterRay = EmitterRay(false, vec3(0.0), kFarAway, 0.0, kNoTriangle, vec3(0.0));

// Whether rays have anything to be aimed at; whether a direction, which is unit, leaves a surface on the side where it
// was reached; and the density with which cosineDirection() chooses the direction, per sr.
bool hasEmitters() { return emitterCount() > 0u || hasEnvironmentMap(); }
bool facesTo(TracedSurface v, vec3 direction) { return dot(v.normal, direction) > 0.0 && dot(v.face, direction) > 0.0; }
float cosineDensity(TracedSurface v, vec3 direction) { return dot(v.normal, direction) / kPi; }

// Probability with which aimedRay() chooses a surface and not the environment.
float surfaceShare() { return !hasEnvironmentMap() ? 1.0 : emitterCount() == 0u ? 0.0 : 0.5; }

// A random ray from v to what emits light. u: uniform in [0, 1), x chooses what; stream: of random numbers.
EmitterRay aimedRay(TracedSurface v, vec3 u) {
  float share = surfaceShare();
  if (u.x >= share) {
    if (!hasEnvironmentMap()) return kNoEmitterRay;
    MapSample s = sampleMap(vec2(u.y, u.z));
    bool lights_ = s.density > 0.0 && facesTo(v, s.direction);
    if (!lights_) return kNoEmitterRay;
    return EmitterRay(true, s.direction, kFarAway, (1.0 - share) * s.density, kNoTriangle, s.radiance);
  }
  if (emitterCount() == 0u) return kNoEmitterRay;
  EmitterPoint p = sampleEmitters(receiverOf(v), u.x / share, vec2(u.y, u.z));
  vec3 to = p.position - v.origin;
  float d2 = dot(to, to);
  if (p.triangle == kNoTriangle || !(d2 > 0.0)) return kNoEmitterRay;
  float distance_ = sqrt(d2);
  vec3 direction = to / distance_;
  float cosine = -dot(p.normal, direction);
  if (!(cosine > 0.0) || !facesTo(v, direction)) return kNoEmitterRay;
  return EmitterRay(true, direction, distance_, share * p.density * d2 / cosine, p.triangle, p.radiance);
}

// The same with numbers of a stream.
EmitterRay aimedRay(TracedSurface v, uint stream) {
  uint own = hashCombine(stream, kAimedRayStream);
  return aimedRay(v, vec3(uniformFloat(hashCombine(own, 2u)), streamSequence(own, 0u)));
}

// The ray to the environment map in a given direction, which is unit, with the density that aimedRay() has for it.
EmitterRay rayOutside(TracedSurface v, vec3 direction) {
  if (!hasEnvironmentMap() || isMapBlack() || !facesTo(v, direction)) return kNoEmitterRay;
  return EmitterRay(true, direction, kFarAway, (1.0 - surfaceShare()) * mapDensity(direction), kNoTriangle,
                    environmentRadiance(direction));
}

// The share of the light of an aimed ray that reaches v, by channels. Traces a ray.
vec3 visibleShare(TracedSurface v, EmitterRay to) { return lightAlong(v.origin, to.direction, to.distance_); }

// Density with which aimedRay() chooses the direction from v to the surface `hit`, per sr; 0 if `hit` does not emit.
float aimedDensity(TracedSurface v, TracedSurface hit) {
  float density = surfaceShare() * emitterDensity(hit.triangle, hit.weights, receiverOf(v));
  vec3 to = hit.position - v.origin;
  float d2 = dot(to, to);
  return density * d2 * sqrt(d2) / max(abs(dot(hit.face, to)), 1e-12);
}

// Direct light at v, estimated by one aimed ray: mean radiance over the hemisphere weighted by the cosine, W/(sr m^2).
// It is its part in the balance heuristic beside `count` other rays, which may hit emissive surfaces by chance. stream:
// of random numbers; byLobe: the other rays are chosen by the reflection `full` and not by the cosine, and the result
// is the radiance that leaves v.
vec3 fromEmitters(TracedSurface v, float count, uint stream, bool byLobe, Reflection full) {
  if (!hasEmitters()) return vec3(0.0);
  EmitterRay to = aimedRay(v, stream);
  if (!to.there) return vec3(0.0);
  float density = cosineDensity(v, to.direction);
  vec3 response = vec3(density);
#if RAY_PASSAGE
  if (byLobe) {
    density = reflectionDensity(full, to.direction);
    response = reflectedFrom(full, to.direction);
  }
#endif
  if (response == vec3(0.0)) return vec3(0.0);
  return to.radiance * visibleShare(v, to) * (response / (to.density + count * density));
}

// What a ray that leaves a surface meets.
struct Arrival {
  TracedSurface next;
  vec3 rho, light;  // its reflectance and radiance, W/(sr m^2); the environment's if nothing was met
};

// Traces a ray from the surface `at`, and finds the light of lamps, of emission and of the environment at its end, the
// last two by the balance heuristic. direction: unit; density: that of the direction, per sr, times the number of such
// rays.
Arrival arrival(TracedSurface at, vec3 direction, float density) {
  Arrival a = Arrival(arrive(at.origin, direction, kFarAway), vec3(0.0), vec3(0.0));
  if (!a.next.there) {
    EmitterRay outside = kNoEmitterRay;
    if (a.next.triangle == kNoTriangle) outside = rayOutside(at, direction);
    if (outside.there) a.light = a.next.brighter * outside.radiance * (density / (outside.density + density));
    return a;
  }
  a.rho = reflectance(a.next);
  a.light = directTowards(a.next, -direction, a.rho, kGatheredRoughness);
  vec3 emission = emitted(a.next);
  if (emission != vec3(0.0)) a.light += emission * (density / (aimedDensity(at, a.next) + density));
  return a;
}

// Radiance that reaches v from emissive surfaces and the environment map directly, and from all light sources after 1
// to `bounces` reflections by other surfaces: the mean over the hemisphere weighted by the cosine, W/(sr m^2), which is
// the irradiance / pi. It is estimated with `count` rays, each of which continues with one ray per further bounce, and
// with one aimed ray at each vertex. stream: of random numbers. isFull, which is a constant: with full materials `full`
// says how v reflects that light, and the result is the radiance that leaves v. The light of lamps at v is not part of
// it: see directLight() in rays/reflection.glsl.
vec3 gather(TracedSurface v, uint bounces, uint count, uint stream, bool isFull, Reflection full) {
  vec3 sum = vec3(0.0);
  for (uint ray = 0u; ray < max(count, 1u); ++ray) {
    TracedSurface at = v;
#if RAY_PASSAGE
    if (isFull) at.normal = full.reflector.normal;
#endif
    vec3 throughput = vec3(1.0);
    uint rays = bounces > 0u ? count : 0u, turn_ = ray, own = stream;
    for (uint left = bounces;; --left) {
      bool byLobe = isFull && left == bounces;
      // All rays from v share one point.
      if (left < bounces || ray == 0u) sum += throughput * fromEmitters(at, float(rays), own, byLobe, full);
      if (left == 0u) break;
      vec3 direction;
      float density;
      if (byLobe) {
#if RAY_PASSAGE
        float choice = uniformFloat(hashCombine(hashCombine(own, kLobeStream), turn_));
        direction = sampleReflection(full, choice, streamSequence(own, turn_));
        density = reflectionDensity(full, direction);
        if (!(density > 0.0)) break;
        throughput = reflectedFrom(full, direction) / density;
        if (throughput == vec3(0.0)) break;
#endif
      } else {
        direction = cosineDirection(at.normal, streamSequence(own, turn_));
        density = cosineDensity(at, direction);
      }
      if (dot(direction, at.face) <= 0.0) break;
      throughput /= float(rays);
      Arrival met = arrival(at, direction, float(rays) * density);
      sum += throughput * met.light;
      if (!met.next.there) break;
      throughput *= met.rho;
      own = hashCombine(own, turn_ + 2u);
      turn_ = 0u;
      rays = left > 1u ? 1u : 0u;
      at = met.next;
    }
    if (bounces == 0u) break;
  }
  return sum;
}

// The same for a diffuse surface.
vec3 gather(TracedSurface v, uint bounces, uint count, uint stream) {
  Reflection unused;
  return gather(v, bounces, count, stream, false, unused);
}

// Radiance that leaves v after it has reflected the light that gather() finds, W/(sr m^2).
vec3 passedOn(TracedSurface v, Reflection r, uint bounces, uint count, uint stream) {
#if RAY_PASSAGE
  return v.brighter * gather(v, bounces, count, stream, true, r);
#else
  return r.rho * gather(v, bounces, count, stream);
#endif
}

#endif
