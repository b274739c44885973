// Rays through the triangles of the scene. Rays pass the holes of alpha masks.
//
// Define: RAY_PASSAGE 0/1, 1 for full materials, where rays hit surfaces of alphaMode BLEND and glass wherever these
// are, and whoever traces decides whether they go on.
//
// Needs a pass that declares `rays`.
#ifndef FOVEA_RAYS_TRACE_GLSL
#define FOVEA_RAYS_TRACE_GLSL

#ifndef RAY_PASSAGE
#error "define RAY_PASSAGE as 0, or as 1 for full materials"
#endif

#include "records/rays.h"
#include "scene/scene.glsl"

CONSTANT uint kNoTriangle = 0xffffffffu;

// A part of a line.
struct Ray {
  vec3 origin;     // world space, m
  vec3 direction;  // need not be unit; distances are multiples of its length
  float near, far; // hits count between these distances
};

// What a ray meets.
struct RayHit {
  uint triangle;   // kNoTriangle if nothing is met
  float distance;  // in lengths of the direction
  vec2 weights;    // barycentric, of the second and third vertex
};

// The distance that a ray must start off a surface, m, so as not to hit it again.
float rayEpsilon() { return kRayEpsilon * max(distance(frame.boundsMin, frame.boundsMax), kLeastDiagonal); }

// Whether a material has no hole at `uv`. alpha: of the vertex colours.
bool solidAt(uint material, vec2 uv, float alpha) {
  int first = int(material) * kMaterialTexels;
  float cutoff = texelOf(sceneMaterials, first + 1).a;
#if RAY_PASSAGE
  if ((uint(texelOf(sceneMaterials, first + kColorTexture).w) & kMaterialBlended) != 0u) return true;
#endif
  return alpha * materialAlpha(material, uv) >= cutoff;
}

// Texture coordinates, and alpha of the vertex colours, at a point of a triangle. weights: barycentric, of the second
// and third vertex.
vec2 uvAt(uvec4 triangle, vec2 weights) {
  return sceneUv(triangle.x) * (1.0 - weights.x - weights.y) + sceneUv(triangle.y) * weights.x +
         sceneUv(triangle.z) * weights.y;
}
float alphaAt(uvec4 triangle, vec2 weights) {
  return sceneAlpha(triangle.x) * (1.0 - weights.x - weights.y) + sceneAlpha(triangle.y) * weights.x +
         sceneAlpha(triangle.z) * weights.y;
}

// The same at a point of a triangle with holes. vertices: of the triangle; weights: of the second and third one.
bool solidAt(uint triangle, uvec4 vertices, vec2 weights) {
  return solidAt(materialOf(sceneTriangle(triangle)), uvAt(vertices, weights), alphaAt(vertices, weights));
}

// trace() finds the nearest hit, or any if that suffices: on the host by Embree or the project's own tracer; on the
// device by ray queries where it has them (rays/hardware.glsl), elsewhere through two trees of bounding boxes
// (rays/bvh.glsl).
#ifdef __cplusplus
RayHit trace(Ray ray, bool any) {
  RayHit hit = RayHit(kNoTriangle, ray.far, vec2(0.0));
  traceOnHost(ray.origin, ray.direction, ray.near, ray.far, any, hit.triangle, hit.distance, hit.weights);
  return hit;
}
#elif defined(WITHOUT_VK_KHR_ray_query)
#include "rays/bvh.glsl"
#else
#include "rays/hardware.glsl"
#endif

// The nearest hit of a ray, and whether there is any.
RayHit intersect(Ray ray) { return trace(ray, false); }
bool occluded(Ray ray) { return trace(ray, true).triangle != kNoTriangle; }

#endif
