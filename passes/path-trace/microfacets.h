// Reflection from smooth and rough interfaces: Fresnel's equations and GGX microfacets (Walter et al., "Microfacet
// Models for Refraction through Rough Surfaces", EGSR 2007). Directions are unit and local, and point away from the
// surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace fovea::path_trace {

// The width of the distribution. roughness: perceptual. A smoother surface cannot be told from a mirror.
inline float ggxWidth(float roughness) { return std::max(roughness * roughness, 1e-3f); }

// Density of the normals h of microfacets, per sr of h and area of the surface (Walter et al., Eq. 33).
inline float ggxDensity(glm::vec3 h, float width) {
  const float w2 = width * width, s = h.x * h.x + h.y * h.y + w2 * h.z * h.z;
  return w2 / (glm::pi<float>() * s * s);
}

// v.z times 1 + 2 Lambda(v), where Smith's Lambda tells how many microfacets hide others from v (Heitz, "Understanding
// the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 2014, Eq. 72).
inline float smithTerm(glm::vec3 v, float width) {
  return std::sqrt(v.z * v.z + width * width * (1 - v.z * v.z));
}

// The BRDF of perfect mirrors as microfacets, per sr: D G / (4 cos cos), with the height-correlated
// G = 1 / (1 + Lambda(in) + Lambda(out)) (Heitz 2014, Eq. 99).
inline float mirrorBrdf(glm::vec3 in, glm::vec3 out, glm::vec3 h, float width) {
  return ggxDensity(h, width) / (2 * (out.z * smithTerm(in, width) + in.z * smithTerm(out, width)));
}

// Density with which reflection at a normal h of sampleVisibleNormal() yields a direction, per sr: that of the visible
// normals, D G1 dot(out, h) / out.z, over 4 dot(out, h).
inline float reflectionDensity(glm::vec3 out, glm::vec3 h, float width) {
  return ggxDensity(h, width) / (2 * (out.z + smithTerm(out, width)));
}

// The normal of a microfacet, chosen among those that `out` sees. Stretched to a hemisphere, they reflect `out` evenly
// to a spherical cap (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 2023). u, v: uniform
// in [0, 1).
inline glm::vec3 sampleVisibleNormal(glm::vec3 out, float width, float u, float v) {
  const glm::vec3 stretch(width, width, 1), from = glm::normalize(stretch * out);
  const float z = 1 - u * (1 + from.z), across = std::sqrt(std::max(1 - z * z, 0.0f)),
              phi = glm::two_pi<float>() * v;
  const glm::vec3 h = glm::vec3(across * std::cos(phi), across * std::sin(phi), z) + from;
  return glm::normalize(stretch * glm::vec3(h.x, h.y, std::max(h.z, 1e-7f)));
}

// Reflectance of an interface for unpolarised light that arrives in air (Born and Wolf, "Principles of Optics", section
// 1.5.2). ior: index of refraction, at least 1.
inline float fresnelReflectance(float cosine, float ior) {
  const float inside = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));  // cosine of the refracted light
  if (!(cosine + inside > 0)) return 1;
  const float s = (cosine - ior * inside) / (cosine + ior * inside),
              p = (ior * cosine - inside) / (ior * cosine + inside);
  return 0.5f * (s * s + p * p);
}

// That at normal incidence. An index of 0 stands for infinity.
inline float normalReflectance(float ior) {
  if (ior == 0) return 1;
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

// How reflectance rises from F0 at normal incidence to F90 at grazing incidence, F0 + (F90 - F0) * curve(cosine): from
// 0 to 1. Metals follow Schlick's approximation (1994), and so do dielectrics without a finite index above 1.
inline float schlickCurve(float cosine) {
  const float c = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return c * c * c * c * c;
}
inline float fresnelCurve(float cosine, float ior) {
  if (ior == 1) return 0;
  if (ior < 1) return schlickCurve(cosine);
  const float normal = normalReflectance(ior);
  return std::max((fresnelReflectance(std::clamp(cosine, 0.0f, 1.0f), ior) - normal) / (1 - normal), 0.0f);
}

}  // namespace fovea::path_trace
