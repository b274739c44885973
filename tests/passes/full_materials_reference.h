// Surfaces with full materials for tests of passes: the G-buffer values of a material, and its albedos from the tables
// of the path tracer.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "passes/path-trace/bsdf.h"
#include "tests/passes/deferred_reference.h"

namespace fovea::test {

inline path_trace::BsdfParameters bsdfParameters(glm::vec3 baseColor, float metallic, float roughness) {
  path_trace::BsdfParameters p;
  p.baseColor = baseColor;
  p.metallic = metallic;
  p.roughness = roughness;
  p.metalAlbedo = &path_trace::AlbedoTable::schlick();
  p.dielectricAlbedo = p.coatAlbedo = &path_trace::AlbedoTable::dielectric(1.5f);
  return p;
}

// What the surface above the diffuse layer reflects of light from one direction, by the formulas of bsdf.h.
// averageCurve and `mean` belong to the same Fresnel curve as `a`.
inline glm::dvec3 surfaceAlbedo(glm::dvec3 f0, double f90, double averageCurve, const path_trace::Albedo& a,
                                const path_trace::Albedo& mean) {
  const glm::dvec3 fresnel = glm::mix(f0, glm::dvec3(f90), averageCurve);
  const double mirror = double(mean.ofMirror());
  const glm::dvec3 lost = fresnel * fresnel * mirror / (1.0 - fresnel * (1 - mirror));
  return f0 * double(a.normal) + f90 * double(a.grazing) + lost * (1 - double(a.ofMirror()));
}

// cosine: of the direction to the eye.
inline glm::dvec3 dielectricAlbedo(const path_trace::BsdfParameters& p, float cosine) {
  return surfaceAlbedo(glm::dvec3(p.specularF0), double(p.specularF90),
                       double(p.dielectricAlbedo->meanCurve()), p.dielectricAlbedo->at(cosine, p.roughness),
                       p.dielectricAlbedo->mean(p.roughness));
}
// Its mean over all directions, for diffuse light.
inline glm::dvec3 dielectricAlbedo(const path_trace::BsdfParameters& p) {
  const path_trace::Albedo mean = p.dielectricAlbedo->mean(p.roughness);
  return surfaceAlbedo(glm::dvec3(p.specularF0), double(p.specularF90),
                       double(p.dielectricAlbedo->meanCurve()), mean, mean);
}
inline glm::dvec3 metalAlbedo(const path_trace::BsdfParameters& p, float cosine) {
  return surfaceAlbedo(glm::dvec3(p.baseColor), 1, double(p.metalAlbedo->meanCurve()),
                       p.metalAlbedo->at(cosine, p.roughness), p.metalAlbedo->mean(p.roughness));
}

// The pixel that gbuffer makes of a surface without a coat, seen with this cosine.
inline void setMaterial(SurfacePixel& pixel, const path_trace::BsdfParameters& p, float cosine) {
  const double below = (1 - double(p.metallic)) * (1 - double(p.transmission));
  pixel.albedo = glm::vec3(glm::dvec3(p.baseColor) * below * (1.0 - dielectricAlbedo(p, cosine)));
  pixel.specular = glm::vec4(glm::mix(p.specularF0, p.baseColor, p.metallic), p.roughness);
  pixel.grazing = glm::mix(p.specularF90, 1.0f, p.metallic);
  pixel.metallic = p.metallic;
}

}  // namespace fovea::test
