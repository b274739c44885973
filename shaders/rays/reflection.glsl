// How traced surfaces reflect light: diffuse ones, and with full materials a GGX lobe above the diffuse layer.
//
// Define: RAY_PASSAGE (rays/trace.glsl), 1 for full materials.
#ifndef FOVEA_RAYS_REFLECTION_GLSL
#define FOVEA_RAYS_REFLECTION_GLSL

#include "rays/surfaces.glsl"
#if RAY_PASSAGE
#include "materials/full_material.glsl"
#endif

// Irradiance from the lamps of the scene, W/m^2, with occlusion: traces a ray to each that faces v.
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

// Radiance that leaves v, whose diffuse reflectance is rho, after it has reflected the light of lamps, W/(sr m^2).
vec3 diffuseLight(TracedSurface v, vec3 rho) { return rho / kPi * irradianceAt(v); }

#if RAY_PASSAGE

// How a surface reflects light in one direction. A clear coat is part of the lobe.
struct Reflection {
  Reflector reflector;
  vec3 albedo;  // of the diffuse layer, as it looks from there
  vec3 emission;  // W/(sr m^2)
  float chooseDiffuse;  // probability with which sampleReflection() takes a direction for the diffuse layer
};

// How v reflects light in the direction `out_`, which is unit. rho: its diffuse reflectance, used with diffuse
// materials alone; leastRoughness: v is treated as at least this rough.
Reflection reflectionOf(TracedSurface v, vec3 out_, vec3 rho, float leastRoughness) {
  uvec4 triangle = sceneTriangle(v.triangle);
  vec3 weights = vec3(1.0 - v.weights.x - v.weights.y, v.weights), a = scenePosition(triangle.x);
  vec3 edgeB = scenePosition(triangle.y) - a, edgeC = scenePosition(triangle.z) - a;
  TextureCoordinates at = textureCoordinates(triangle, weights, v.uv);
  float side = dot(cross(edgeB, edgeC), v.face) < 0.0 ? -1.0 : 1.0;
  int record = int(frame.firstSurface) + int(v.material) * kSurfaceTexels;
  vec3 normal = normalTowards(mappedNormal(record, v.triangle, weights, edgeB, edgeC, v.normal, side, at), out_);
  FullSurface s = fullSurface(v.material, triangle, weights, at, dot(normal, out_), leastRoughness);
  Reflector r = reflectorOf(s.gloss, normal, out_);
  // The lobe and the rest are chosen by their albedos.
  MirrorAlbedo mirror = mirrorAlbedo(dot(normal, out_), s.gloss.roughness);
  vec3 lost = lostAlbedo(s.gloss, r.mean) * max(1.0 - mirror.all, 0.0);
  float lobe = meanChannel(surfaceAlbedo(s.gloss, mirror, r.mean) - s.gloss.metallic * lost);
  float others = meanChannel(s.albedo + lost);
  return Reflection(r, s.albedo, s.emission, others / (others + max(lobe, 1e-3)));
}

// Radiance that is reflected for each unit of radiance from a direction, which is unit, and each sr: f cos.
vec3 reflectedFrom(Reflection r, vec3 direction) {
  float cosine = dot(r.reflector.normal, direction);
  return cosine > 0.0 ? cosine * reflected(r.reflector, direction, r.albedo) : vec3(0.0);
}

// Density with which sampleReflection() chooses a direction, per sr.
float reflectionDensity(Reflection r, vec3 direction) {
  float cosine = dot(r.reflector.normal, direction), alpha = ggxAlpha(r.reflector.gloss.roughness);
  if (!(cosine > 0.0)) return 0.0;
  vec3 out_ = r.reflector.out_, halfway = normalize(direction + out_), across = cross(r.reflector.normal, halfway);
  float c = dot(r.reflector.normal, halfway), a2 = alpha * alpha, s = dot(across, across) + a2 * c * c;
  float z = dot(r.reflector.normal, out_);
  float lambda = smithLambda(vec3(sqrt(max(1.0 - z * z, 0.0)), 0.0, z), alpha);
  float lobe = a2 / (kPi * s * s * (1.0 + lambda) * 4.0 * z);
  return mix(lobe, cosine / kPi, r.chooseDiffuse);
}

// A random direction from which light may arrive, unit, in world space. choice, u: uniform in [0, 1).
vec3 sampleReflection(Reflection r, float choice, vec2 u) {
  if (choice < r.chooseDiffuse) return cosineDirection(r.reflector.normal, u);
  mat3 axes = orthonormalFrame(r.reflector.normal);
  vec3 out_ = toLocal(axes, r.reflector.out_);
  vec3 h = sampleVisibleNormal(out_, ggxAlpha(r.reflector.gloss.roughness), u);
  return toWorld(axes, normalize(2.0 * dot(out_, h) * h - out_));
}

// Radiance that leaves v after it has reflected the light of lamps, W/(sr m^2), with occlusion.
vec3 directLight(TracedSurface v, Reflection r) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.lightCount; ++i) {
    LightSample l = sampleLight(lights[i], v.position);
    if (dot(v.face, l.direction) <= 0.0 || l.irradiance == vec3(0.0)) continue;
    vec3 response = l.irradiance * reflectedFrom(r, l.direction);
    if (response != vec3(0.0)) sum += response * lightAlong(v.origin, l.direction, l.distance);
  }
  return v.brighter * sum;
}

// Radiance that v emits and reflects of the light of lamps in the direction `out_`, which is unit, W/(sr m^2). For
// leastRoughness see reflectionOf().
vec3 seenLight(TracedSurface v, vec3 out_, float leastRoughness) {
  Reflection r = reflectionOf(v, out_, vec3(0.0), leastRoughness);
  return v.brighter * r.emission + directLight(v, r);
}

#else

struct Reflection {
  vec3 rho;  // reflectance
};
Reflection reflectionOf(TracedSurface v, vec3 out_, vec3 rho, float leastRoughness) { return Reflection(rho); }
vec3 directLight(TracedSurface v, Reflection r) { return diffuseLight(v, r.rho); }

#endif

// Radiance that v reflects of the light of lamps in the direction `out_`, W/(sr m^2), with occlusion. For the arguments
// see reflectionOf().
vec3 directTowards(TracedSurface v, vec3 out_, vec3 rho, float leastRoughness) {
  if (frame.lightCount == 0u) return vec3(0.0);
  return directLight(v, reflectionOf(v, out_, rho, leastRoughness));
}

#endif
