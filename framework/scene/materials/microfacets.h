// The GGX distribution of microfacets and Fresnel reflection. Directions are unit, in a frame whose z is the normal of
// the surface, and point away from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace fovea::scene {

// A smoother surface is a mirror to every sampler here.
inline constexpr float kLeastAlpha = 1e-3f;
inline float ggxAlpha(float roughness) { return std::max(roughness * roughness, kLeastAlpha); }

// Density of microfacet normals h per projected area (Walter et al. 2007, Eq. 33), per sr.
inline float ggxDensity(glm::vec3 h, float alpha) {
  const float x = h.x / alpha, y = h.y / alpha, s = x * x + y * y + h.z * h.z;
  return glm::one_over_pi<float>() / (alpha * alpha * s * s);
}

// Smith's Lambda: 1 / (1 + Lambda) of the microfacets that face v are not hidden by others (Heitz 2014, Eq. 72).
inline float smithLambda(glm::vec3 v, float alpha) {
  const float z2 = std::max(v.z * v.z, 1e-14f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * (v.x * v.x + v.y * v.y) / z2) - 1);
}

// A microfacet normal chosen among those that `out` sees (Heitz, "Sampling the GGX Distribution of Visible Normals",
// JCGT 2018). u, v: uniform in [0, 1).
inline glm::vec3 sampleVisibleNormal(glm::vec3 out, float alpha, float u, float v) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * out.x, alpha * out.y, out.z));
  const float side2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::vec3 a =
      side2 > 0 ? glm::vec3(-stretched.y, stretched.x, 0) / std::sqrt(side2) : glm::vec3(1, 0, 0);
  const glm::vec3 b = glm::cross(stretched, a);
  const float r = std::sqrt(u), phi = glm::two_pi<float>() * v, s = 0.5f * (1 + stretched.z);
  const float x = r * std::cos(phi);
  const float y = (1 - s) * std::sqrt(std::max(1 - x * x, 0.0f)) + s * r * std::sin(phi);
  const glm::vec3 n = x * a + y * b + std::sqrt(std::max(1 - x * x - y * y, 0.0f)) * stretched;
  return glm::normalize(glm::vec3(alpha * n.x, alpha * n.y, std::max(n.z, 1e-7f)));
}

// Between F0 at normal and F90 at grazing incidence, Fresnel reflection is F0 + (F90 - F0) * curve(cosine).
inline float schlickCurve(float cosine) {
  const float c = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return c * c * c * c * c;
}

// Reflectance of a dielectric for unpolarised light that arrives from outside. ior: at least 1.
inline float dielectricReflectance(float cosine, float ior) {
  const float c = std::clamp(cosine, 0.0f, 1.0f),
              t = std::sqrt(ior * ior - 1 + c * c);  // t: ior * cosine inside
  if (c + t == 0) return 1;
  const float s = (c - t) / (c + t), p = (t - ior * ior * c) / (t + ior * ior * c);
  return 0.5f * (s * s + p * p);
}

inline float normalReflectance(float ior) {
  return ior == 0 ? 1.0f : ((ior - 1) / (ior + 1)) * ((ior - 1) / (ior + 1));
}

// The curve with which F0 = normalReflectance(ior) and F90 = 1 give the exact reflectance; Schlick's where there is
// none (ior 0 stands for infinity, and a surface of ior 1 reflects nothing).
inline float dielectricCurve(float cosine, float ior) {
  const float f0 = normalReflectance(ior);
  if (ior <= 1) return ior == 1 ? 0.0f : schlickCurve(cosine);
  return std::max((dielectricReflectance(cosine, ior) - f0) / (1 - f0), 0.0f);
}

}  // namespace fovea::scene
