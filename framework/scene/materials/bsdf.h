// How a surface scatters light, as glTF 2.0 defines it in its appendix B, with the extensions KHR_materials_ior,
// _specular, _clearcoat and _transmission (as thin glass).
//
//   f = (1 - c A_c(i)) (1 - c A_c(o)) ((1 - m) dielectric + m metal) + c coat
//
// Metals and the surfaces of dielectrics are GGX microfacets with height-correlated Smith masking. The Fresnel
// reflection is Schlick's approximation for metals and exact for dielectrics. What light loses in the model because it
// is scattered only once is given back by a lobe of its own (Kulla and Conty, "Revisiting Physically Based Shading at
// Imageworks", SIGGRAPH course 2017). Beneath the surface of a dielectric lies a diffuse layer that gets what the
// surface does not reflect, in the form of the same authors: with the albedo A of the surface,
//
//   (1 - A(i)) (1 - A(o)) / (pi (1 - mean A)) * baseColor,
//
// so that f is reciprocal and a white surface reflects all light. The coat's factors let no light be gained but lose
// some: light between coat and surface is not followed.
//
// Thin glass lets the share `transmission` of what enters the diffuse layer go straight through instead; roughness
// blurs only what the glass reflects.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "framework/scene/materials/albedo_table.h"

namespace fovea::scene {

// The albedo of light scattered more than once among microfacets, as a share of what single scattering loses (Kulla
// and Conty 2017). fresnel: mean reflectance; mirror: mean albedo of a mirror.
glm::vec3 lostAlbedo(glm::vec3 fresnel, float mirror);

// A material at a point, with its textures looked up.
struct BsdfParameters {
  glm::vec3 baseColor{1};
  float metallic = 0, roughness = 1;
  glm::vec3 specularF0{0.04f};  // of the dielectric part
  float specularF90 = 1;
  float ior = 1.5f;  // gives the curve between the two
  float transmission = 0;
  float clearcoat = 0, clearcoatRoughness = 0;
  // For Schlick's curve, for that of `ior` and for that of 1.5, the coat's. They must outlive the BSDF.
  const AlbedoTable *metalAlbedo = nullptr, *dielectricAlbedo = nullptr, *coatAlbedo = nullptr;
};

// Everything that depends on the point and on the direction to the viewer. Directions are unit and local: z is the
// shading normal.
class Bsdf {
 public:
  // out: to the viewer, z > 0.
  Bsdf(const BsdfParameters& parameters, glm::vec3 out);

  // f times the cosine of `in`, per sr; 0 below the surface.
  glm::vec3 evaluate(glm::vec3 in) const;
  // The density with which sample() chooses `in`, per sr.
  float density(glm::vec3 in) const;

  struct Sample {
    glm::vec3 in{0};
    glm::vec3 weight{0};  // evaluate(in) / density
    float density = 0;    // per sr
  };
  // Nothing if the surface reflects nothing, or if the direction that was chosen lies below it. choice, u, v: uniform
  // in [0, 1).
  std::optional<Sample> sample(float choice, float u, float v) const;

  // The share of light that goes straight through, the same in both directions.
  glm::vec3 transmittance() const { return transmittance_; }

 private:
  struct Coupling {           // of one direction
    glm::vec3 dielectric{0};  // albedo of the surface of the dielectric part
    float lost = 0;           // 1 - albedo of a mirror: what single scattering loses
    float coat = 0;           // albedo of the coat times its share
  };
  Coupling couplingOf(float cosine) const;

  BsdfParameters p_;
  glm::vec3 out_;
  float alpha_, coatAlpha_;
  Coupling fromOut_;
  glm::vec3 lostFactor_{0};      // of the lobe of multiple scattering, with its normalisation
  glm::vec3 dielectricLost_{0};  // albedo of that lobe for the dielectric part, per `lost`
  glm::vec3 diffuse_{0};         // factor of the diffuse layer, with its normalisation
  glm::vec3 transmittance_{0};
  float chooseCoat_ = 0, chooseSpecular_ = 0, chooseDiffuse_ = 0;  // probabilities
};

}  // namespace fovea::scene
