// What the surface of a full material reflects, by what the G-buffer keeps of it: a lobe of GGX microfacets with
// Fresnel's factor above a diffuse layer. Albedos of the lobe come from tables, which also make up for the light that
// microfacets scatter more than once (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH
// 2017 course). A clear coat is part of the same lobe.
#ifndef FOVEA_GLOSS_GLSL
#define FOVEA_GLOSS_GLSL

#include "materials/microfacets.glsl"
#include "records/mirror.h"
#include "scene/scene.glsl"

// The mean of Fresnel's curve over the directions, weighted by their cosine: Schlick's and that of a dielectric with an
// index of refraction of 1.5, which stands for all dielectrics.
CONSTANT float kMetalCurve = 1.0 / 21.0, kDielectricCurve = 0.0539357;

// Whether a pixel may show another surface in the next frame, as one of them lets light through. normalA: alpha of the
// G-buffer's `normal`.
bool isVeiled(float normalA) { return normalA < 0.0; }

// The lobe of a surface.
struct Gloss {
  vec3 f0;  // reflectance at normal incidence, and for each channel at grazing incidence
  float f90;
  float roughness;  // perceptual
  float metallic;
  float dielectricF0;  // mean of the channels of F0 of the part that is no metal, which is above the diffuse layer
};

// The lobe as the G-buffer keeps it: in `specular` and in the alphas of `normal`, `albedo` and `emission`.
Gloss glossOf(vec4 specular, float normalA, float albedoA, float emissionA) {
  return Gloss(vec3(specular), abs(normalA), specular.a, albedoA, emissionA);
}

// F90 of the part that is no metal.
float dielectricF90(Gloss g) { return clamp((g.f90 - g.metallic) / max(1.0 - g.metallic, 1e-3), 0.0, 1.0); }

// Whether most of what a surface reflects is in its lobe. specular: of the G-buffer.
bool looksMetallic(vec4 specular) { return max(max(specular.r, specular.g), specular.b) > kMetallicF0; }

// The share of the light under the lobe that rays find (pass reflections) and not VPLs, from 0 to 1. specular: of the
// G-buffer.
float tracedShare(vec4 specular) {
  float last = (looksMetallic(specular) ? kTracedMetal : kTracedDielectric) + kTracedFade;
  return vec3(specular) == vec3(0.0) ? 0.0 : clamp((last - specular.a) / kTracedFade, 0.0, 1.0);
}

// ---- Albedos -----------------------------------------------------------------------------------------------------

// The albedo of the lobe for light from one direction, or its mean over all directions.
struct MirrorAlbedo {
  float all;                      // of a perfect mirror that scatters light once
  float metalF90, dielectricF90;  // the part of it that a Fresnel curve gives to F90
};

// An albedo as the tables hold it.
MirrorAlbedo mirrorAlbedoOf(vec4 texel) { return MirrorAlbedo(texel.x, texel.y, texel.z); }

// A row of the tables, interpolated at a column from 0 to 1.
vec4 albedoRow(int row, float column) {
  float x = clamp(column, 0.0, 1.0) * float(kAlbedoSide - 1u), first = min(floor(x), float(kAlbedoSide - 2u));
  int i = int(frame.firstAlbedo) + row * int(kAlbedoSide) + int(first);
  return mix(texelOf(sceneMaterials, i), texelOf(sceneMaterials, i + 1), x - first);
}

// The albedo for light at an angle of this cosine to the normal. roughness: perceptual.
MirrorAlbedo mirrorAlbedo(float cosine, float roughness) {
  float column = (sqrt(max(cosine, 0.0)) - kAlbedoLeastRoot) / (1.0 - kAlbedoLeastRoot);
  float y = clamp(roughness, 0.0, 1.0) * float(kAlbedoSide - 1u), first = min(floor(y), float(kAlbedoSide - 2u));
  return mirrorAlbedoOf(mix(albedoRow(int(first), column), albedoRow(int(first) + 1, column), y - first));
}

// Its mean over all directions, weighted by the cosine.
MirrorAlbedo meanMirrorAlbedo(float roughness) { return mirrorAlbedoOf(albedoRow(int(kAlbedoSide), roughness)); }

// Light that is scattered more than once, as a share of what single scattering loses. fresnel: mean reflectance;
// mirror: mean albedo of a perfect mirror; mean: as meanMirrorAlbedo() returns it.
vec3 lostAlbedo(vec3 fresnel, float mirror) { return fresnel * fresnel * mirror / (1.0 - fresnel * (1.0 - mirror)); }
vec3 lostAlbedo(Gloss g, MirrorAlbedo mean) {
  vec3 f0 = g.metallic > 0.0 ? vec3(g.dielectricF0) : g.f0;
  vec3 metalF0 = clamp((g.f0 - (1.0 - g.metallic) * f0) / max(g.metallic, 1e-3), 0.0, 1.0);
  return mix(lostAlbedo(mix(f0, vec3(dielectricF90(g)), kDielectricCurve), mean.all),
             lostAlbedo(mix(metalF0, vec3(1.0), kMetalCurve), mean.all), g.metallic);
}

// The share of light from one direction that the lobe reflects, or its mean over the directions if `a` is the mean.
vec3 surfaceAlbedo(Gloss g, MirrorAlbedo a, MirrorAlbedo mean) {
  float high = mix(a.dielectricF90, a.metalF90, g.metallic);
  return min(g.f0 * (a.all - high) + g.f90 * high + lostAlbedo(g, mean) * (1.0 - a.all), 1.0);
}

// The same for the part that is no metal, in one channel. f0, f90: of that part.
float dielectricAlbedo(float f0, float f90, MirrorAlbedo a, MirrorAlbedo mean) {
  float lost = lostAlbedo(vec3(mix(f0, f90, kDielectricCurve)), mean.all).x;
  return min(f0 * (a.all - a.dielectricF90) + f90 * a.dielectricF90 + lost * (1.0 - a.all), 1.0);
}

// ---- Light from one direction --------------------------------------------------------------------------------------

// A surface as light from single directions finds it, with all that does not depend on these.
struct Reflector {
  Gloss gloss;
  vec3 normal, out_;  // unit; out_: to the eye
  MirrorAlbedo mean;
  vec3 lost;  // of the lobe of light that is scattered more than once, times what the direction `out_` loses
  float dielectricF90, layer;  // layer: 1 / (1 - mean albedo above the diffuse layer)
};

// normal, toEye: unit.
Reflector reflectorOf(Gloss g, vec3 normal, vec3 toEye) {
  MirrorAlbedo mean = meanMirrorAlbedo(g.roughness), a = mirrorAlbedo(dot(normal, toEye), g.roughness);
  vec3 lost = lostAlbedo(g, mean) * (max(1.0 - a.all, 0.0) / (kPi * max(1.0 - mean.all, 1e-6)));
  float f90 = dielectricF90(g);
  float layer = 1.0 / max(1.0 - dielectricAlbedo(g.dielectricF0, f90, mean, mean), 1e-6);
  return Reflector(g, normal, toEye, mean, lost, f90, layer);
}

// Radiance towards the eye, W/(sr m^2), for each W/m^2 of irradiance from a direction, which is unit. albedo: of the
// diffuse layer, as the G-buffer keeps it.
vec3 reflected(Reflector r, vec3 direction, vec3 albedo) {
  Gloss g = r.gloss;
  MirrorAlbedo a = mirrorAlbedo(dot(r.normal, direction), g.roughness);
  vec3 halfway = normalize(direction + r.out_);
  vec3 fresnel = mix(g.f0, vec3(g.f90), fresnelCurve(dot(direction, halfway), g.metallic));
  vec3 single = fresnel * ggxReflection(r.normal, direction, r.out_, halfway, ggxAlpha(g.roughness));
  float through = (1.0 - dielectricAlbedo(g.dielectricF0, r.dielectricF90, a, r.mean)) * r.layer;
  return single + r.lost * max(1.0 - a.all, 0.0) + albedo * (through / kPi);
}

#endif
