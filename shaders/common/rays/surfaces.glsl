// Single rays through the triangles and the light at what they meet, as scene::SurfaceTracer finds it on the host.
// Define: RAY_PASSAGE 0/1 (common/rays/trace.glsl).
#ifndef FOVEA_RAYS_SURFACES_GLSL
#define FOVEA_RAYS_SURFACES_GLSL

#include "common/paraboloid.glsl"
#include "common/pixel_ray.glsl"
#include "common/random.glsl"
#include "common/rays/emitters.glsl"
#include "common/rays/visibility.glsl"

// A surface as seen by the ray that reached it.
struct TracedSurface {
  bool there;     // false on a black back, too
  uint triangle;  // kNoTriangle if the ray has met nothing
  uint material;
  vec2 weights;   // barycentric, of the triangle's second and third vertex
  vec3 position;  // world space, m
  vec3 origin;    // start of rays that leave it, just off the surface
  vec3 normal, face;  // shading and geometric, unit, on the side reached
  vec2 uv;
  // The factor on its light that makes up for the rays that glass has let through, and what glass before it makes of
  // the light on its way along the ray; the latter alone if the ray met nothing.
  vec3 brighter;
};

uint rayCount = 0u;  // rays that this invocation has traced

Receiver receiverOf(TracedSurface v) { return Receiver(v.origin, v.normal); }

// ---- Random directions ---------------------------------------------------------------------------------------------

vec3 cosineDirection(vec3 normal, vec2 u) {
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
  return toWorld(orthonormalFrame(normal), vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x)));
}

// ---- What rays meet ------------------------------------------------------------------------------------------------

const TracedSurface kNothingTraced = TracedSurface(false, kNoTriangle, 0u, vec2(0.0), vec3(0.0), vec3(0.0), vec3(0.0),
                                                   vec3(0.0), vec2(0.0), vec3(1.0));

// direction: unit.
TracedSurface surfaceOf(RayHit hit, vec3 direction) {
  TracedSurface v = kNothingTraced;
  if (hit.triangle == kNoTriangle) return v;
  uvec4 triangle = sceneTriangle(hit.triangle);
  vec3 weights = vec3(1.0 - hit.weights.x - hit.weights.y, hit.weights);
  vec3 a = scenePosition(triangle.x), b = scenePosition(triangle.y), c = scenePosition(triangle.z);
  v.triangle = hit.triangle;
  v.material = materialOf(triangle);
  v.weights = hit.weights;
  v.position = mat3(a, b, c) * weights;
  vec3 face = cross(b - a, c - a);
  float size = length(face);
  face = size > 0.0 ? face / size : vec3(0.0, 1.0, 0.0);
  vec3 normal = mat3(sceneNormal(triangle.x), sceneNormal(triangle.y), sceneNormal(triangle.z)) * weights;
  normal = dot(normal, normal) > 1e-24 ? normalize(normal) : face;
  if (dot(normal, face) < 0.0) normal = -normal;
  bool front = dot(face, direction) < 0.0;
  uint flags = uint(texelOf(sceneMaterials, int(v.material) * kMaterialTexels + kColorTexture).w);
  v.there = front || (flags & kMaterialDoubleSided) != 0u;
  v.normal = front ? normal : -normal;
  v.face = front ? face : -face;
  v.origin = v.position + (v.face - direction) * rayEpsilon();
  v.uv = uvAt(triangle, hit.weights);
#if RAY_PASSAGE
  if ((flags & kMaterialTransmits) != 0u)
    v.brighter /= 1.0 - passage(v.material, v.uv, abs(dot(v.normal, direction)));
#endif
  return v;
}

#if RAY_PASSAGE
uint materialFlags(TracedSurface v) {
  return uint(texelOf(sceneMaterials, int(v.material) * kMaterialTexels + kColorTexture).w);
}
bool isGlass(TracedSurface v) { return (materialFlags(v) & kMaterialTransmits) != 0u; }

// Whether a ray passes a surface that it meets. direction: unit; chance: uniform in [0, 1).
bool passesSurface(TracedSurface v, vec3 direction, float chance) {
  return (materialFlags(v) & (kMaterialBlended | kMaterialTransmits)) != 0u &&
         !stops(v.material, v.uv, abs(dot(v.normal, direction)), chance);
}
#endif

// Different for every ray and frame.
uint keyOfRay(vec3 origin, vec3 direction) {
  uint key = randomStream(frame.seed, frame.index, kPassedRayStream, 0u);
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(origin[i]));
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(direction[i]));
  return key;
}

// The surface that the eye sees at a point of the picture, pixels (centres at +0.5). Where surfaces let a part of the
// light through, it is the one that pass gbuffer shows in this frame.
TracedSurface look(vec2 at) {
  vec3 direction = normalize(pixelRay(at)), tint = vec3(1.0);
  Ray ray = Ray(view.eye, direction, 0.0, kFarAway);
  uint key = hashCombine(frame.seed, kPassageStream);
  TracedSurface v = kNothingTraced;
  for (uint pane = 0u; pane < kMaxPanes; ++pane) {
    ++rayCount;
    RayHit hit = intersect(ray);
    v = surfaceOf(hit, direction);
#if RAY_PASSAGE
    float chance = passageChance(hashCombine(key, hit.triangle), uvec2(at), frame.index);
    bool passed = hit.triangle != kNoTriangle && (!v.there || passesSurface(v, direction, chance));
    if (!passed) break;
    if (v.there && isGlass(v)) tint *= glassTint(v.material, v.uv);
#else
    if (hit.triangle == kNoTriangle || v.there) break;
#endif
    ray = beyond(ray, hit);
    v = kNothingTraced;
  }
  v.brighter *= tint;
  return v;
}

// The surface met within `reach` metres. direction: unit. Where surfaces let a part of the light through, the ray
// passes with the probability of the light that does.
TracedSurface arrive(vec3 origin, vec3 direction, float reach) {
  Ray ray = Ray(origin, direction, 0.0, reach);
#if RAY_PASSAGE
  uint key = keyOfRay(origin, direction);
  vec3 tint = vec3(1.0);
  TracedSurface v = kNothingTraced;
  for (uint pane = 0u; pane < kMaxPanes; ++pane) {
    ++rayCount;
    RayHit hit = intersect(ray);
    v = surfaceOf(hit, direction);
    if (hit.triangle == kNoTriangle ||
        !passesSurface(v, direction, uniformFloat(hashCombine(key, hit.triangle))))
      break;
    if (v.there && isGlass(v)) tint *= glassTint(v.material, v.uv);
    ray = beyond(ray, hit);
    v = kNothingTraced;
  }
  v.brighter *= tint;
  return v;
#else
  ++rayCount;
  return surfaceOf(intersect(ray), direction);
#endif
}

vec3 lightAlong(vec3 origin, vec3 direction, float distance_) {
  ++rayCount;
  return visibility(Ray(origin, direction, 0.0, distance_ < kFarAway ? distance_ * kShadowEnd : kFarAway));
}

// ---- Light ---------------------------------------------------------------------------------------------------------

vec3 reflectance(TracedSurface v) { return v.brighter * materialReflectance(v.material, v.uv).rgb; }
vec3 emitted(TracedSurface v) {
  return emitterCount() == 0u ? vec3(0.0) : v.brighter * materialEmission(v.material, v.uv);
}

// Irradiance from the scene's lights.
vec3 irradianceAt(TracedSurface v) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.lightCount; ++i) {
    LightSample l = sampleLight(lights[i], v.position);
    float cosine = dot(v.normal, l.direction);
    if (dot(v.face, l.direction) <= 0.0 || cosine <= 0.0 || l.irradiance == vec3(0.0)) continue;
    sum += l.irradiance * cosine * lightAlong(v.origin, l.direction, l.distance);
  }
  return sum;
}

// Radiance that leaves v, whose reflectance is rho, after one reflection of light from the scene's lights.
vec3 directLight(TracedSurface v, vec3 rho) { return rho / kPi * irradianceAt(v); }

// The ray from v to a point on an emissive surface, or to the scene's environment map.
struct EmitterRay {
  bool there;       // whether a point was found that faces v and may light it; it may be hidden
  vec3 direction;   // unit
  float distance_;  // m; kFarAway to the environment
  float density;    // probability density of the direction, per sr
  uint triangle;    // kNoTriangle in the environment
  vec3 radiance;    // W/(sr m^2)
};

const EmitterRay kNoEmitterRay = EmitterRay(false, vec3(0.0), kFarAway, 0.0, kNoTriangle, vec3(0.0));

bool hasEmitters() { return emitterCount() > 0u || hasEnvironmentMap(); }
bool facesTo(TracedSurface v, vec3 direction) { return dot(v.normal, direction) > 0.0 && dot(v.face, direction) > 0.0; }
float cosineDensity(TracedSurface v, vec3 direction) { return dot(v.normal, direction) / kPi; }

// Probability with which aimedRay() chooses a surface, not the environment.
float surfaceShare() { return !hasEnvironmentMap() ? 1.0 : emitterCount() == 0u ? 0.0 : 0.5; }

// u: uniform in [0, 1); x chooses the emitter.
EmitterRay aimedRay(TracedSurface v, vec3 u) {
  float share = surfaceShare();
  if (u.x >= share) {
    if (!hasEnvironmentMap()) return kNoEmitterRay;
    MapSample s = sampleMap(u.yz);
    bool lights_ = s.density > 0.0 && facesTo(v, s.direction);
    if (!lights_) return kNoEmitterRay;
    return EmitterRay(true, s.direction, kFarAway, (1.0 - share) * s.density, kNoTriangle, s.radiance);
  }
  if (emitterCount() == 0u) return kNoEmitterRay;
  EmitterPoint p = sampleEmitters(receiverOf(v), u.x / share, u.yz);
  vec3 to = p.position - v.origin;
  float d2 = dot(to, to);
  if (p.triangle == kNoTriangle || !(d2 > 0.0)) return kNoEmitterRay;
  float distance_ = sqrt(d2);
  vec3 direction = to / distance_;
  float cosine = -dot(p.normal, direction);
  if (!(cosine > 0.0) || !facesTo(v, direction)) return kNoEmitterRay;
  return EmitterRay(true, direction, distance_, share * p.density * d2 / cosine, p.triangle, p.radiance);
}

EmitterRay aimedRay(TracedSurface v, uint stream) {
  uint own = hashCombine(stream, kAimedRayStream);
  return aimedRay(v, vec3(uniformFloat(hashCombine(own, 2u)), streamSequence(own, 0u)));
}

// The ray to the environment map in a given direction, which is unit.
EmitterRay rayOutside(TracedSurface v, vec3 direction) {
  if (!hasEnvironmentMap() || isMapBlack() || !facesTo(v, direction)) return kNoEmitterRay;
  return EmitterRay(true, direction, kFarAway, (1.0 - surfaceShare()) * mapDensity(direction), kNoTriangle,
                    environmentRadiance(direction));
}

// The share of its light that reaches v.
vec3 visibleShare(TracedSurface v, EmitterRay to) { return lightAlong(v.origin, to.direction, to.distance_); }

// Density with which aimedRay() chooses the direction from v to the surface `hit`, per sr; 0 if `hit` does not emit.
float aimedDensity(TracedSurface v, TracedSurface hit) {
  float density = surfaceShare() * emitterDensity(hit.triangle, receiverOf(v));
  vec3 to = hit.position - v.origin;
  float d2 = dot(to, to);
  return density * d2 * sqrt(d2) / max(abs(dot(hit.face, to)), 1e-12);
}

// The part of one point on an emissive surface in the balance heuristic (Veach and Guibas 1995), beside `count`
// cosine-weighted rays that may hit such a surface by chance.
vec3 fromEmitters(TracedSurface v, float count, uint stream) {
  if (!hasEmitters()) return vec3(0.0);
  EmitterRay to = aimedRay(v, stream);
  if (!to.there) return vec3(0.0);
  float cosine = cosineDensity(v, to.direction);
  return to.radiance * visibleShare(v, to) * (cosine / (to.density + count * cosine));
}

// Cosine-weighted mean radiance that reaches v over its hemisphere from emissive surfaces, and that of all light after
// at most `bounces` reflections, estimated with `count` rays, each of which continues with one ray per further bounce,
// and with one point on an emissive surface at each vertex.
vec3 gather(TracedSurface v, uint bounces, uint count, uint stream) {
  vec3 sum = vec3(0.0);
  for (uint ray = 0u; ray < max(count, 1u); ++ray) {
    TracedSurface at = v;
    vec3 throughput = vec3(1.0);
    uint rays = bounces > 0u ? count : 0u, turn_ = ray, own = stream;
    for (uint left = bounces;; --left) {
      // All rays from v share one point.
      if (left < bounces || ray == 0u) sum += throughput * fromEmitters(at, float(rays), own);
      if (left == 0u) break;
      vec3 direction = cosineDirection(at.normal, streamSequence(own, turn_));
      if (dot(direction, at.face) <= 0.0) break;
      TracedSurface next = arrive(at.origin, direction, kFarAway);
      // The part of cosine-weighted rays in the balance heuristic is this over the sum with the other density.
      float cosine = float(rays) * cosineDensity(at, direction);
      throughput /= float(rays);
      if (!next.there) {
        EmitterRay outside = kNoEmitterRay;
        if (next.triangle == kNoTriangle) outside = rayOutside(at, direction);
        if (outside.there) sum += throughput * next.brighter * outside.radiance * (cosine / (outside.density + cosine));
        break;
      }
      vec3 rho = reflectance(next), light = directLight(next, rho), shining = emitted(next);
      if (shining != vec3(0.0)) light += shining * (cosine / (aimedDensity(at, next) + cosine));
      sum += throughput * light;
      throughput *= rho;
      own = hashCombine(own, turn_ + 2u);
      turn_ = 0u;
      rays = left > 1u ? 1u : 0u;
      at = next;
    }
    if (bounces == 0u) break;
  }
  return sum;
}

#endif
