// How a surface scatters light, as appendix B of glTF 2.0 defines it, with the extensions KHR_materials_ior, _specular,
// _clearcoat and _transmission (as thin glass).
//
// A surface is a rough interface, of a metal or of a dielectric, in the shares `metallic` and 1 - `metallic`. What
// microfacets lose because light is scattered only once among them is given back by a lobe of its own, and what does
// not return from the interface of a dielectric enters a diffuse layer below (Kulla and Conty, "Revisiting Physically
// Based Shading at Imageworks", SIGGRAPH course 2017). A clear coat, rough as well, lies above all of this: what it
// reflects on the way in and on the way out does not come through. Light that goes to and fro below the coat is not
// followed.
//
// Thin glass lets the share `transmission` of what enters the diffuse layer go straight through instead.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "passes/path-trace/albedo.h"

namespace fovea::path_trace {

// A material at a point, with its textures looked up.
struct BsdfParameters {
  glm::vec3 baseColor{1};
  float metallic = 0, roughness = 1;
  glm::vec3 specularF0{0.04f};  // of the dielectric
  float specularF90 = 1;
  float ior = 1.5f;  // gives the curve between the two
  float transmission = 0;
  float clearcoat = 0, clearcoatRoughness = 0;
  // Those of schlick(), dielectric(ior) and dielectric(1.5); they have to outlive the BSDF.
  const AlbedoTable *metalAlbedo = nullptr, *dielectricAlbedo = nullptr, *coatAlbedo = nullptr;
};

// The albedo of light that is scattered more than once among microfacets, as a share of what a mirror of this roughness
// loses by single scattering (Kulla and Conty 2017). fresnel: mean reflectance; mirror: mean albedo of the mirror.
glm::vec3 multipleAlbedo(glm::vec3 fresnel, float mirror);

// Directions are unit and local.
class Bsdf {
 public:
  // out: to the viewer, z > 0.
  Bsdf(const BsdfParameters& parameters, glm::vec3 out);

  // The BSDF times the cosine of `in`, per sr; 0 below the surface.
  glm::vec3 evaluate(glm::vec3 in) const;
  // The density with which sample() chooses `in`, per sr.
  float density(glm::vec3 in) const;
  struct Sample {
    glm::vec3 in{0};
    glm::vec3 weight{0};  // evaluate(in) / density
    float density = 0;    // per sr
  };
  // Nothing if the direction that was chosen lies below the surface. choice, u, v: uniform in [0, 1).
  std::optional<Sample> sample(float choice, float u, float v) const;

  // The share of light that goes straight through, the same in both directions.
  glm::vec3 transmittance() const { return transmittance_; }

 private:
  // What becomes of light from or to one direction.
  struct Passing {
    float coat = 1;         // share that the coat lets through
    glm::vec3 entering{1};  // share of this that the interface of the dielectric lets in
    float lost = 0;         // what single scattering at a mirror loses
  };
  Passing passing(float cosine) const;

  BsdfParameters p_;
  glm::vec3 out_;
  float width_, coatWidth_;
  glm::vec3 dielectricMultiple_{0};  // multipleAlbedo()
  glm::vec3 multiple_{0},
      diffuse_{0};  // factors of these two lobes on what both directions have of them, per sr
  Passing passingOut_;
  glm::vec3 transmittance_{0};
  float chooseCoat_ = 0, chooseInterface_ = 0,
        chooseCosine_ = 0;  // probabilities of ways to choose directions
};

}  // namespace fovea::path_trace
