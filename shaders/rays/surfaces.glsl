// Single rays through the triangles, and the surfaces that they meet.
//
// Define: RAY_PASSAGE (rays/trace.glsl).
#ifndef FOVEA_RAYS_SURFACES_GLSL
#define FOVEA_RAYS_SURFACES_GLSL

#include "vpls/paraboloid.glsl"
#include "screen/pixel_ray.glsl"
#include "sampling/random.glsl"
#include "rays/emitters.glsl"
#include "rays/visibility.glsl"

// A surface as seen by the ray that reached it.
struct TracedSurface {
  bool there;     // false also on the back of a surface that is not double-sided, which is black
  uint triangle;  // kNoTriangle if the ray has met nothing
  uint material;
  vec2 weights;   // barycentric, of the triangle's second and third vertex
  vec3 position;  // world space, m
  vec3 origin;    // start of rays that leave it, just off the surface, world space, m
  vec3 normal, face;  // shading and geometric, unit, on the side reached
  vec2 uv;
  // The factor on its light that makes up for the rays that glass has let through, times the tint of the glass that the
  // ray has passed; the latter alone if the ray met nothing.
  vec3 brighter;
};

uint rayCount = 0u;  // rays that this invocation has traced

// The surface as receiver of emitted light (rays/emitters.glsl).
Receiver receiverOf(TracedSurface v) { return Receiver(v.origin, v.normal); }

// ---- Random directions ---------------------------------------------------------------------------------------------

// A direction around a unit normal, with a density in proportion to the cosine. u: uniform in [0, 1).
vec3 cosineDirection(vec3 normal, vec2 u) {
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
  return toWorld(orthonormalFrame(normal), vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x)));
}

// ---- What rays meet ------------------------------------------------------------------------------------------------

// What a ray meets that meets nothing.
CONSTANT TracedSurface kNothingTraced =
    TracedSurface(false, kNoTriangle, 0u, vec2(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0), vec3(1.0));

// The surface at a hit. direction: of the ray, unit.
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
  normal = dot(normal, normal) > 1e-12 ? normalize(normal) : face;
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
// Flags of the material (records/scene.h), and whether it is glass.
uint materialFlags(TracedSurface v) {
  return uint(texelOf(sceneMaterials, int(v.material) * kMaterialTexels + kColorTexture).w);
}
bool isGlass(TracedSurface v) { return (materialFlags(v) & kMaterialTransmits) != 0u; }

// Whether a ray passes a surface that it meets, as a random decision. direction: unit; chance: uniform in [0, 1).
bool passesSurface(TracedSurface v, vec3 direction, float chance) {
  return (materialFlags(v) & (kMaterialBlended | kMaterialTransmits)) != 0u &&
         !stops(v.material, v.uv, alphaAt(sceneTriangle(v.triangle), v.weights), abs(dot(v.normal, direction)), chance);
}
#endif

// A random number for each ray and frame.
uint keyOfRay(vec3 origin, vec3 direction) {
  uint key = randomStream(frame.seed, frame.index, kPassedRayStream, 0u);
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(origin[i]));
  for (int i = 0; i < 3; ++i) key = hashCombine(key, floatBitsToUint(direction[i]));
  return key;
}

// The surface that the eye sees at a point of the picture, in pixels, whose centres are at +0.5. Where surfaces let a
// part of the light through, it is the one that pass gbuffer shows in this frame.
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

// The surface that a ray meets within `reach` metres. origin: world space, m; direction: unit. Where surfaces let a
// share of the light through, the ray passes with that probability.
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

// The share of light that passes along a ray, by channels. origin: world space, m; direction: unit; distance_: of the
// light source, m, from kFarAway on without end.
vec3 lightAlong(vec3 origin, vec3 direction, float distance_) {
  return visibility(Ray(origin, direction, 0.0, distance_ < kFarAway ? distance_ * kShadowEnd : kFarAway), rayCount);
}

// ---- Light ---------------------------------------------------------------------------------------------------------

// The mean of the channels.
float meanChannel(vec3 colour) { return (colour.r + colour.g + colour.b) / 3.0; }

// Diffuse reflectance of the surface, and the radiance that it emits, W/(sr m^2).
vec3 reflectance(TracedSurface v) { return v.brighter * vec3(materialReflectance(v.material, v.uv)); }
vec3 emitted(TracedSurface v) {
  return emitterCount() == 0u ? vec3(0.0) : v.brighter * materialEmission(v.material, v.uv);
}

#endif
