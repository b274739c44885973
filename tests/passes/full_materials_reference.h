// Surfaces with full materials for tests of passes: the G-buffer values of a material, and its albedos from the tables
// of the path tracer.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "framework/scene/materials/bsdf.h"
#include "framework/scene/materials/microfacets.h"
#include "tests/passes/deferred_reference.h"

namespace fovea::test {

inline scene::BsdfParameters bsdfParameters(glm::vec3 baseColor, float metallic, float roughness) {
  scene::BsdfParameters p;
  p.baseColor = baseColor;
  p.metallic = metallic;
  p.roughness = roughness;
  p.metalAlbedo = &scene::AlbedoTable::schlick();
  p.dielectricAlbedo = p.coatAlbedo = &scene::AlbedoTable::dielectric(1.5f);
  return p;
}

// What the surface above the diffuse layer reflects of light from one direction, by the formulas of bsdf.h.
// averageCurve and `mean` belong to the same Fresnel curve as `a`.
inline glm::dvec3 surfaceAlbedo(glm::dvec3 f0, double f90, double averageCurve, const scene::Albedo& a,
                                const scene::Albedo& mean) {
  const glm::dvec3 fresnel = glm::mix(f0, glm::dvec3(f90), averageCurve);
  const double mirror = double(mean.total());
  const glm::dvec3 lost = fresnel * fresnel * mirror / (1.0 - fresnel * (1 - mirror));
  return f0 * double(a.low) + f90 * double(a.high) + lost * (1 - double(a.total()));
}

// cosine: of the direction to the eye.
inline glm::dvec3 dielectricAlbedo(const scene::BsdfParameters& p, float cosine) {
  return surfaceAlbedo(glm::dvec3(p.specularF0), double(p.specularF90),
                       double(p.dielectricAlbedo->averageCurve()),
                       p.dielectricAlbedo->at(cosine, p.roughness), p.dielectricAlbedo->average(p.roughness));
}
// Its mean over all directions, for diffuse light.
inline glm::dvec3 dielectricAlbedo(const scene::BsdfParameters& p) {
  const scene::Albedo mean = p.dielectricAlbedo->average(p.roughness);
  return surfaceAlbedo(glm::dvec3(p.specularF0), double(p.specularF90),
                       double(p.dielectricAlbedo->averageCurve()), mean, mean);
}
inline glm::dvec3 metalAlbedo(const scene::BsdfParameters& p, float cosine) {
  return surfaceAlbedo(glm::dvec3(p.baseColor), 1, double(p.metalAlbedo->averageCurve()),
                       p.metalAlbedo->at(cosine, p.roughness), p.metalAlbedo->average(p.roughness));
}

// The pixel that gbuffer makes of a surface without a coat, seen with this cosine.
inline void setMaterial(SurfacePixel& pixel, const scene::BsdfParameters& p, float cosine) {
  const double below = (1 - double(p.metallic)) * (1 - double(p.transmission));
  pixel.albedo = glm::vec3(glm::dvec3(p.baseColor) * below * (1.0 - dielectricAlbedo(p, cosine)));
  pixel.specular = glm::vec4(glm::mix(p.specularF0, p.baseColor, p.metallic), p.roughness);
  pixel.grazing = glm::mix(p.specularF90, 1.0f, p.metallic);
  pixel.metallic = p.metallic;
}

}  // namespace fovea::test
