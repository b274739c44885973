// What a ray sees of a surface with full materials, as scene::SurfaceTracer::seen() finds it on the host. RAY_PASSAGE
// is 1 and MATERIAL_DETAIL defined (common/materials/full_material.glsl).
#ifndef FOVEA_RAYS_SEEN_SURFACE_GLSL
#define FOVEA_RAYS_SEEN_SURFACE_GLSL

#include "common/materials/full_material.glsl"
#include "common/rays/surfaces.glsl"

// Radiance from v in the direction `out_` (unit), from where it is seen: emitted, or light of the scene's lights after
// one reflection. leastRoughness: v is treated as at least this rough.
vec3 seenLight(TracedSurface v, vec3 out_, float leastRoughness) {
  uvec4 triangle = sceneTriangle(v.triangle);
  vec3 weights = vec3(1.0 - v.weights.x - v.weights.y, v.weights), a = scenePosition(triangle.x);
  vec3 edgeB = scenePosition(triangle.y) - a, edgeC = scenePosition(triangle.z) - a;
  TextureCoordinates at = textureCoordinates(triangle, weights, v.uv);
  float side = dot(cross(edgeB, edgeC), v.face) < 0.0 ? -1.0 : 1.0;
  int record = int(frame.firstSurface) + int(v.material) * kSurfaceTexels;
  vec3 normal = normalTowards(mappedNormal(record, v.triangle, weights, edgeB, edgeC, v.normal, side, at), out_);
  FullSurface surface = fullSurface(v.material, triangle, weights, at, dot(normal, out_), leastRoughness);
  Reflector reflector = reflectorOf(surface.gloss, normal, out_);
  vec3 sum = surface.emission;
  for (uint i = 0u; i < frame.lightCount; ++i) {
    LightSample l = sampleLight(lights[i], v.position);
    float cosine = dot(normal, l.direction);
    if (dot(v.face, l.direction) <= 0.0 || cosine <= 0.0 || l.irradiance == vec3(0.0)) continue;
    vec3 response = l.irradiance * cosine * reflected(reflector, l.direction, surface.albedo);
    if (response != vec3(0.0)) sum += response * lightAlong(v.origin, l.direction, l.distance);
  }
  return v.brighter * sum;
}

#endif
