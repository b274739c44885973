// Microfacets with GGX's distribution of normals, and Fresnel's reflection at them. Directions are unit and point away
// from the surface; where no normal is given, they are in a frame whose z is the normal of the surface.
#ifndef FOVEA_MICROFACETS_GLSL
#define FOVEA_MICROFACETS_GLSL

#include "device/constants.glsl"

// GGX's alpha of a perceptual roughness.
float ggxAlpha(float roughness) { return max(roughness * roughness, 1e-3); }

// Smith's Lambda: 1 / (1 + Lambda) of the microfacets that face v are not hidden by others (Heitz 2014, Eq. 72).
float smithLambda(vec3 v, float alpha) {
  return 0.5 * (sqrt(1.0 + alpha * alpha * dot(vec2(v), vec2(v)) / max(v.z * v.z, 1e-14)) - 1.0);
}

// A random microfacet normal among those that `out_` sees (Heitz, "Sampling the GGX Distribution of Visible Normals",
// JCGT 2018). u: uniform in [0, 1).
vec3 sampleVisibleNormal(vec3 out_, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * vec2(out_), out_.z));
  float side2 = dot(vec2(stretched), vec2(stretched));
  vec3 a = side2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(side2) : vec3(1.0, 0.0, 0.0);
  vec3 b = cross(stretched, a);
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y, s = 0.5 * (1.0 + stretched.z), x = r * cos(phi);
  float y = mix(sqrt(max(1.0 - x * x, 0.0)), r * sin(phi), s);
  vec3 n = x * a + y * b + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
  return normalize(vec3(alpha * vec2(n), max(n.z, 1e-7)));
}

// Where Fresnel's factor lies between F0 (0) and F90 (1): Schlick's curve for metals, for dielectrics a polynomial that
// is within 0.002 of the exact curve. cosine: between light and microfacet.
float fresnelCurve(float cosine, float metallic) {
  float u = 1.0 - clamp(cosine, 0.0, 1.0), u2 = u * u, u4 = u2 * u2;
  float dielectric = u2 * (-0.03423537 + u * (0.48114462 - 0.04706973 * u2)) + 0.60016048 * u4 * u4;
  return mix(dielectric, u4 * u, metallic);
}

// D G / (4 cos cos): GGX's distribution of microfacets (Walter et al., EGSR 2007) with height-correlated masking
// (Heitz, JCGT 2014), per sr. Directions are unit; halfway: between `from` and `to`.
float ggxReflection(vec3 normal, vec3 from, vec3 to, vec3 halfway, float alpha) {
  vec3 across = cross(normal, halfway);  // the sine is exact where the cosine is almost 1
  float a2 = alpha * alpha, cosine = dot(normal, halfway), s = dot(across, across) + a2 * cosine * cosine;
  float in_ = max(dot(normal, from), 1e-6), out_ = max(dot(normal, to), 1e-6);
  float masking = in_ * sqrt(a2 + (1.0 - a2) * out_ * out_) + out_ * sqrt(a2 + (1.0 - a2) * in_ * in_);
  return a2 / (kPi * s * s) * 0.5 / masking;
}

#endif
