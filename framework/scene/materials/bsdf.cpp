#include "framework/scene/materials/bsdf.h"

#include <algorithm>
#include <cmath>

#include "framework/scene/materials/microfacets.h"

namespace fovea::scene {
namespace {

constexpr float kInversePi = glm::one_over_pi<float>();
constexpr float kCoatIor = 1.5f;  // KHR_materials_clearcoat

float mean(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

}  // namespace

glm::vec3 lostAlbedo(glm::vec3 fresnel, float mirror) {
  return fresnel * fresnel * mirror / (glm::vec3(1) - fresnel * (1 - mirror));
}

Bsdf::Bsdf(const BsdfParameters& parameters, glm::vec3 out)
    : p_(parameters),
      out_(out),
      alpha_(ggxAlpha(parameters.roughness)),
      coatAlpha_(ggxAlpha(parameters.clearcoatRoughness)) {
  const Albedo averageMetal = p_.metalAlbedo->average(p_.roughness),
               averageDielectric = p_.dielectricAlbedo->average(p_.roughness);
  const float mirror = averageMetal.total(), curve = p_.dielectricAlbedo->averageCurve(),
              schlick = p_.metalAlbedo->averageCurve();
  dielectricLost_ = lostAlbedo(glm::mix(p_.specularF0, glm::vec3(p_.specularF90), curve), mirror);
  const glm::vec3 metalLost = lostAlbedo(glm::mix(p_.baseColor, glm::vec3(1), schlick), mirror);
  const float lost = std::max(1 - mirror, 1e-6f);
  lostFactor_ = glm::mix(dielectricLost_, metalLost, p_.metallic) * (kInversePi / lost);
  const glm::vec3 averageSurface = p_.specularF0 * averageDielectric.low +
                                   p_.specularF90 * averageDielectric.high + dielectricLost_ * (1 - mirror);
  const glm::vec3 below = p_.baseColor * (1 - p_.metallic);
  diffuse_ = below * (1 - p_.transmission) * kInversePi / glm::max(glm::vec3(1) - averageSurface, 1e-6f);

  fromOut_ = couplingOf(out.z);
  const float coated = 1 - fromOut_.coat;
  const glm::vec3 entering = glm::vec3(1) - fromOut_.dielectric;
  transmittance_ = below * p_.transmission * entering * (coated * coated);

  // Lobes are chosen by their albedos. That of the single scattering of metals needs no table of its own here.
  const Albedo metal = p_.metalAlbedo->at(out.z, p_.roughness);
  const glm::vec3 surface =
      glm::mix(fromOut_.dielectric, p_.baseColor * metal.low + glm::vec3(metal.high), p_.metallic);
  chooseCoat_ = fromOut_.coat;
  chooseSpecular_ = coated * std::max(mean(surface), 1e-3f);
  chooseDiffuse_ = coated * (mean(below * (1 - p_.transmission) * entering) +
                             mean(glm::mix(dielectricLost_, metalLost, p_.metallic)) * fromOut_.lost);
  const float sum = chooseCoat_ + chooseSpecular_ + chooseDiffuse_;
  chooseCoat_ /= sum;
  chooseSpecular_ /= sum;
  chooseDiffuse_ /= sum;
}

Bsdf::Coupling Bsdf::couplingOf(float cosine) const {
  Coupling c;
  const Albedo a = p_.dielectricAlbedo->at(cosine, p_.roughness);
  c.lost = std::max(1 - a.total(), 0.0f);
  c.dielectric = glm::min(p_.specularF0 * a.low + p_.specularF90 * a.high + dielectricLost_ * c.lost, 1.0f);
  if (p_.clearcoat > 0) {
    const Albedo coat = p_.coatAlbedo->at(cosine, p_.clearcoatRoughness);
    c.coat = p_.clearcoat * (normalReflectance(kCoatIor) * coat.low + coat.high);
  }
  return c;
}

glm::vec3 Bsdf::evaluate(glm::vec3 in) const {
  if (!(in.z > 0)) return glm::vec3(0);
  const Coupling c = couplingOf(in.z);
  const glm::vec3 h = glm::normalize(in + out_);
  const float facing = glm::dot(in, h);
  const glm::vec3 dielectric =
      glm::mix(p_.specularF0, glm::vec3(p_.specularF90), dielectricCurve(facing, p_.ior));
  const glm::vec3 metal = glm::mix(p_.baseColor, glm::vec3(1), schlickCurve(facing));
  glm::vec3 f = glm::mix(dielectric, metal, p_.metallic) * ggxReflection(in, out_, h, alpha_);
  f += lostFactor_ * (c.lost * fromOut_.lost);
  f += diffuse_ * (glm::vec3(1) - c.dielectric) * (glm::vec3(1) - fromOut_.dielectric);
  f *= (1 - c.coat) * (1 - fromOut_.coat);
  if (p_.clearcoat > 0)
    f += p_.clearcoat * dielectricReflectance(facing, kCoatIor) * ggxReflection(in, out_, h, coatAlpha_);
  return f * in.z;
}

float Bsdf::density(glm::vec3 in) const {
  if (!(in.z > 0)) return 0;
  const glm::vec3 h = glm::normalize(in + out_);
  float density =
      chooseDiffuse_ * in.z * kInversePi + chooseSpecular_ * visibleReflectionDensity(out_, h, alpha_);
  if (chooseCoat_ > 0) density += chooseCoat_ * visibleReflectionDensity(out_, h, coatAlpha_);
  return density;
}

std::optional<Bsdf::Sample> Bsdf::sample(float choice, float u, float v) const {
  Sample s;
  if (choice < chooseDiffuse_) {
    const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
    s.in = {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - u, 0.0f))};
  } else {
    const float alpha = choice < chooseDiffuse_ + chooseSpecular_ ? alpha_ : coatAlpha_;
    const glm::vec3 h = sampleVisibleNormal(out_, alpha, u, v);
    s.in = glm::normalize(2 * glm::dot(out_, h) * h - out_);
  }
  s.density = density(s.in);
  if (!(s.density > 0)) return std::nullopt;
  s.weight = evaluate(s.in) / s.density;
  return s;
}

}  // namespace fovea::scene
