// Single rays through the triangles and the light at what they meet, as scene::SurfaceTracer finds it on the host. Define:
// RAY_PASSAGE 0/1 (common/rays/trace.glsl).
#ifndef FOVEA_RAYS_SURFACES_GLSL
#define FOVEA_RAYS_SURFACES_GLSL

#include "common/paraboloid.glsl"
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
  // The factor on its light that makes up for the rays that glass has let through, and what glass before it makes of the
  // light on its way along the ray; the latter alone if the ray met nothing.
  vec3 brighter;
};

uint rayCount = 0u;  // rays that this invocation has traced

Receiver receiverOf(TracedSurface v) { return Receiver(v.origin, v.normal); }

// ---- Random directions ---------------------------------------------------------------------------------------------

// Point `turn_` of the R2 sequence (Roberts 2018), whose starting point is drawn from `stream`.
vec2 streamSequence(uint stream, uint turn_) {
  return vec2(uniformFloat(hashCombine(stream, 0u) + turn_ * 3242174889u),
              uniformFloat(hashCombine(stream, 1u) + turn_ * 2447445414u));
}

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

// Different for every ray and frame.
uint keyOfRay(vec3 origin, vec3 direction) {
  uint key = randomStream(frame.seed, frame.index, kPassedRayStream, 0u);
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(origin[i]));
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(direction[i]));
  return key;
}

// The surface met within `reach` metres. direction: unit. Where surfaces let a part of the light through, the ray passes
// with the probability of the light that does.
TracedSurface arrive(vec3 origin, vec3 direction, float reach) {
  Ray ray = Ray(origin, direction, 0.0, reach);
#if RAY_PASSAGE
  uint key = keyOfRay(origin, direction);
  vec3 tint = vec3(1.0);
  TracedSurface v;
  for (uint pane = 0u; pane < kMaxPanes; ++pane) {
    ++rayCount;
    RayHit hit = intersect(ray);
    v = surfaceOf(hit, direction);
    if (hit.triangle == kNoTriangle) break;
    uint flags = uint(texelOf(sceneMaterials, int(v.material) * kMaterialTexels + kColorTexture).w);
    if ((flags & (kMaterialBlended | kMaterialTransmits)) == 0u ||
        stops(v.material, v.uv, abs(dot(v.normal, direction)), uniformFloat(hashCombine(key, hit.triangle))))
      break;
    if (v.there && (flags & kMaterialTransmits) != 0u) tint *= glassTint(v.material, v.uv);
    ray.near = uintBitsToFloat(floatBitsToUint(hit.distance) + 1u) * (1.0 + 1e-6);
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
  bool there;      // whether a point was found that faces v and may light it; it may be hidden
  vec3 direction;  // unit
  float distance_;  // m; kFarAway to the environment
  float density;   // probability density of the direction, per sr
  vec3 radiance;   // W/(sr m^2)
};

// Probability with which aimedRay() chooses a surface, not the environment.
float surfaceShare() { return !hasEnvironmentMap() ? 1.0 : emitterCount() == 0u ? 0.0 : 0.5; }

EmitterRay aimedRay(TracedSurface v, uint stream) {
  EmitterRay ray = EmitterRay(false, vec3(0.0), kFarAway, 0.0, vec3(0.0));
  uint own = hashCombine(stream, kAimedRayStream);
  float choice = uniformFloat(hashCombine(own, 2u)), share = surfaceShare();
  vec2 u = streamSequence(own, 0u);
  if (choice >= share) {
    MapSample s = sampleMap(u);
    bool lights_ = s.density > 0.0 && dot(v.normal, s.direction) > 0.0 && dot(v.face, s.direction) > 0.0;
    return lights_ ? EmitterRay(true, s.direction, kFarAway, (1.0 - share) * s.density, s.radiance) : ray;
  }
  if (emitterCount() == 0u) return ray;
  EmitterPoint p = sampleEmitters(receiverOf(v), choice / share, u);
  vec3 to = p.position - v.origin;
  float d2 = dot(to, to);
  if (p.triangle == kNoTriangle || !(d2 > 0.0)) return ray;
  float distance_ = sqrt(d2);
  vec3 direction = to / distance_;
  float cosine = -dot(p.normal, direction);
  if (!(cosine > 0.0) || dot(v.normal, direction) <= 0.0 || dot(v.face, direction) <= 0.0) return ray;
  return EmitterRay(true, direction, distance_, share * p.density * d2 / cosine, p.radiance);
}

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
  if (emitterCount() == 0u && !hasEnvironmentMap()) return vec3(0.0);
  EmitterRay to = aimedRay(v, stream);
  if (!to.there) return vec3(0.0);
  float cosine = dot(v.normal, to.direction) / kPi;
  return to.radiance * lightAlong(v.origin, to.direction, to.distance_) * (cosine / (to.density + count * cosine));
}

// The light of the environment map in the direction of a cosine-weighted ray from v that met nothing, in the balance
// heuristic beside a ray aimed there.
vec3 fromOutside(TracedSurface v, vec3 direction) {
  if (!hasEnvironmentMap() || isMapBlack()) return vec3(0.0);
  float cosine = dot(v.normal, direction) / kPi, density = (1.0 - surfaceShare()) * mapDensity(direction);
  return environmentRadiance(direction) * (cosine / (density + cosine));
}

// Cosine-weighted mean radiance that reaches v over its hemisphere from emissive surfaces, and that of all light after at
// most `bounces` reflections, estimated with one ray, which continues with one per further bounce, and with one point on
// an emissive surface at each vertex.
vec3 gather(TracedSurface v, uint bounces, uint stream) {
  vec3 sum = vec3(0.0), throughput = vec3(1.0);
  for (uint bounce = 0u;; ++bounce) {
    bool last = bounce >= bounces;
    sum += throughput * fromEmitters(v, last ? 0.0 : 1.0, stream);
    if (last) break;
    vec3 direction = cosineDirection(v.normal, streamSequence(stream, 0u));
    if (dot(direction, v.face) <= 0.0) break;
    TracedSurface next = arrive(v.origin, direction, kFarAway);
    if (!next.there) {
      if (next.triangle == kNoTriangle) sum += throughput * next.brighter * fromOutside(v, direction);
      break;
    }
    vec3 rho = reflectance(next), light = directLight(next, rho), shining = emitted(next);
    if (shining != vec3(0.0)) {
      float cosine = dot(v.normal, direction) / kPi;
      light += shining * (cosine / (aimedDensity(v, next) + cosine));
    }
    sum += throughput * light;
    throughput *= rho;
    stream = hashCombine(stream, 2u);
    v = next;
  }
  return sum;
}

#endif
