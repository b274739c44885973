// Where surfaces let light through: holes of alpha masks, and with full materials alphaMode BLEND and thin glass.
// Arguments of the functions: material is its number, uv the first set of texture coordinates, alpha that of the vertex
// colours, cosine that between light and normal, above 0.
#ifndef FOVEA_PASSAGE_GLSL
#define FOVEA_PASSAGE_GLSL

#include "materials/gloss.glsl"
#include "sampling/random.glsl"

// Texels of a SurfaceRecord in `sceneMaterials`, and at which of them its textures start.
CONSTANT int kSurfaceTexels = 25, kMetallicRoughnessTexture = 4, kNormalTexture = 7, kSpecularTexture = 10,
          kSpecularColorTexture = 13, kTransmissionTexture = 16, kClearcoatTexture = 19,
          kClearcoatRoughnessTexture = 22;

// The share of light that the substance of glass lets through, by channels.
vec3 glassColor(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels, surface = int(frame.firstSurface) + int(material) * kSurfaceTexels;
  return min(vec3(texelOf(sceneMaterials, surface)) * vec3(sampleSceneTexture(first + kColorTexture, uv)), 1.0);
}

// The share of light that goes straight through thin glass, mean of the channels. For full materials alone.
float passage(uint material, vec2 uv, float cosine) {
  int surface = int(frame.firstSurface) + int(material) * kSurfaceTexels;
  vec4 color = texelOf(sceneMaterials, surface), specular = texelOf(sceneMaterials, surface + 1),
       factors = texelOf(sceneMaterials, surface + 2),
       metalAndRoughness = sampleSceneTexture(surface + kMetallicRoughnessTexture, uv);
  float enters = factors.z * sampleSceneTexture(surface + kTransmissionTexture, uv).r *
                 (1.0 - color.a * metalAndRoughness.b);
  MirrorAlbedo a = mirrorAlbedo(cosine, factors.x * metalAndRoughness.g);
  float f0 = dot(min(vec3(specular), 1.0), vec3(1.0 / 3.0));
  float reflects = specular.a * (f0 * (a.all - a.dielectricF90) + a.dielectricF90);
  return clamp(dot(glassColor(material, uv), vec3(1.0 / 3.0)) * enters * (1.0 - reflects), 0.0, kMostPassed);
}

// The colour that light takes on in glass, relative to the mean of its channels.
vec3 glassTint(uint material, vec2 uv) {
  vec3 color = max(glassColor(material, uv), kDarkestGlass);
  return color / dot(color, vec3(1.0 / 3.0));
}

// The share of light that the surface stops before any of it enters glass: alpha of BLEND, 0 or 1 of MASK, else 1.
// flags, cutoff: of the material, if they are known already.
float coverage(uint material, vec2 uv, float alpha, uint flags, float cutoff) {
  if (cutoff == 0.0) return 1.0;
  int first = int(material) * kMaterialTexels;
  float all = alpha * texelOf(sceneMaterials, first).a * sampleSceneTexture(first + kColorTexture, uv).a;
  return (flags & kMaterialBlended) != 0u ? clamp(all, 0.0, 1.0) : float(all >= cutoff);
}

// The same, with both looked up.
float coverage(uint material, vec2 uv, float alpha) {
  int first = int(material) * kMaterialTexels;
  uint flags = uint(texelOf(sceneMaterials, first + kColorTexture).w);
  return coverage(material, uv, alpha, flags, texelOf(sceneMaterials, first + 1).a);
}

// Whether a surface stops a ray, as a random decision. chance: uniform in [0, 1), or kEitherWay, with which rays pass
// if at least half of the light does.
bool stops(uint material, vec2 uv, float alpha, float cosine, float chance) {
  int first = int(material) * kMaterialTexels;
  float cutoff = texelOf(sceneMaterials, first + 1).a;
  if (cutoff == 0.0) return true;
  uint flags = uint(texelOf(sceneMaterials, first + kColorTexture).w);
  float stopped = coverage(material, uv, alpha, flags, cutoff);
  // Few materials are glass.
  if ((flags & kMaterialTransmits) != 0u)
    stopped *= 1.0 - passage(material, uv, cosine);
  return stopped > chance;
}

// The share of light that passes the surface, beside what covers it or through the glass, by channels. For full
// materials alone.
vec3 transmittance(uint material, vec2 uv, float alpha, float cosine) {
  int first = int(material) * kMaterialTexels;
  uint flags = uint(texelOf(sceneMaterials, first + kColorTexture).w);
  float covered = coverage(material, uv, alpha, flags, texelOf(sceneMaterials, first + 1).a);
  vec3 share = vec3(1.0 - covered);
  if ((flags & kMaterialTransmits) != 0u)
    share += covered * passage(material, uv, cosine) * glassTint(material, uv);
  return share;
}

// The chance for stops() of a ray through a pixel: over neighbouring pixels and over turns the numbers are a
// low-discrepancy sequence, so that a few of them tell the share. key: random, of the triangle, so that surfaces behind
// each other let rays pass independently; turn_: number of the turn, such as the frame.
float passageChance(uint key, uvec2 pixel, uint turn_) {
  uvec2 at = (key & 8u) != 0u ? uvec2(pixel.y, pixel.x) : pixel;
  uint along = (key & 16u) != 0u ? 0u - at.y : at.y;
  return uniformFloat(key + at.x * kPassageAcross + along * kPassageAlong +
                      turn_ * (kPassageTurn + (key & 7u) * kPassageTurns));
}

// The chance and the cosine for what is looked up once and has no direction, such as a voxel.
CONSTANT float kEitherWay = 0.5, kMeanCosine = 0.67;

#endif
