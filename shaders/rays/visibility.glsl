// How much light passes along a ray.
//
// Define: RAY_PASSAGE (rays/trace.glsl).
#ifndef FOVEA_RAYS_VISIBILITY_GLSL
#define FOVEA_RAYS_VISIBILITY_GLSL

#include "materials/passage.glsl"
#include "rays/trace.glsl"

// The geometric normal of a triangle, world space, not normalised.
vec3 faceNormal(uvec4 triangle) {
  vec3 a = scenePosition(triangle.x);
  return cross(scenePosition(triangle.y) - a, scenePosition(triangle.z) - a);
}

// The rest of a ray behind a hit that it passes.
Ray beyond(Ray ray, RayHit hit) {
  ray.near = uintBitsToFloat(floatBitsToUint(hit.distance) + 1u) * (1.0 + 1e-6);
  return ray;
}

// The share of light that passes along the ray, by channels: 0 or 1, and with full materials what BLEND and glass let
// through. rays: grows by the number of rays traced, one more for each surface that is passed.
vec3 visibility(Ray ray, INOUT(uint) rays) {
#if RAY_PASSAGE
  vec3 share = vec3(1.0), direction = normalize(ray.direction);
  for (uint pane = 0u; pane < kMaxPanes; ++pane) {
    ++rays;
    RayHit hit = trace(ray, frame.transparent == 0u);
    if (hit.triangle == kNoTriangle) return share;
    if (frame.transparent == 0u) break;
    uvec4 triangle = sceneTriangle(hit.triangle);
    uint material = materialOf(triangle);
    uint flags = uint(texelOf(sceneMaterials, int(material) * kMaterialTexels + kColorTexture).w);
    if ((flags & (kMaterialBlended | kMaterialTransmits)) == 0u) break;
    vec3 weights = vec3(1.0 - hit.weights.x - hit.weights.y, hit.weights);
    vec3 normal = mat3(sceneNormal(triangle.x), sceneNormal(triangle.y), sceneNormal(triangle.z)) * weights;
    if (!(dot(normal, normal) > 1e-12)) normal = faceNormal(triangle);
    share *= transmittance(material, uvAt(triangle, hit.weights), alphaAt(triangle, hit.weights),
                           abs(dot(normalize(normal), direction)));
    if (share == vec3(0.0)) break;
    ray = beyond(ray, hit);
  }
  return vec3(0.0);
#else
  ++rays;
  return vec3(occluded(ray) ? 0.0 : 1.0);
#endif
}

// The same without counting.
vec3 visibility(Ray ray) {
  uint rays = 0u;
  return visibility(ray, rays);
}

#endif
