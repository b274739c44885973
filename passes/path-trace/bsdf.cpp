#include "passes/path-trace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "passes/path-trace/microfacets.h"

namespace fovea::path_trace {
namespace {

constexpr float kInversePi = glm::one_over_pi<float>();
constexpr float kCoatIor = 1.5f;

float mean(glm::vec3 c) { return (c.r + c.g + c.b) / 3; }

glm::vec3 reflected(glm::vec3 f0, glm::vec3 f90, Albedo a) { return f0 * a.normal + f90 * a.grazing; }

}  // namespace

glm::vec3 multipleAlbedo(glm::vec3 fresnel, float mirror) {
  return fresnel * fresnel * mirror / (1.0f - fresnel * (1 - mirror));
}

Bsdf::Bsdf(const BsdfParameters& parameters, glm::vec3 out)
    : p_(parameters), out_(out), width_(ggxWidth(p_.roughness)), coatWidth_(ggxWidth(p_.clearcoatRoughness)) {
  const glm::vec3 f90(p_.specularF90);
  const Albedo meanAlbedo = p_.dielectricAlbedo->mean(p_.roughness);
  const float mirror = meanAlbedo.ofMirror(), lost = std::max(1 - mirror, 1e-6f);
  dielectricMultiple_ =
      multipleAlbedo(glm::mix(p_.specularF0, f90, p_.dielectricAlbedo->meanCurve()), mirror);
  const glm::vec3 metalMultiple = multipleAlbedo(
                      glm::mix(p_.baseColor, glm::vec3(1), p_.metalAlbedo->meanCurve()), mirror),
                  multiple = glm::mix(dielectricMultiple_, metalMultiple, p_.metallic);
  // Both lobes are products of what the two directions have, over the mean of it.
  multiple_ = multiple * kInversePi / lost;
  const glm::vec3 below = p_.baseColor * (1 - p_.metallic), remains = below * (1 - p_.transmission),
                  meanEntering =
                      1.0f - reflected(p_.specularF0, f90, meanAlbedo) - dielectricMultiple_ * (1 - mirror);
  diffuse_ = remains * kInversePi / glm::max(meanEntering, 1e-6f);

  passingOut_ = passing(out.z);
  const float coat = passingOut_.coat;
  transmittance_ = below * p_.transmission * passingOut_.entering * coat * coat;

  // Each way to choose directions gets the albedo of the lobes that it suits.
  const glm::vec3 metal = reflected(p_.baseColor, glm::vec3(1), p_.metalAlbedo->at(out.z, p_.roughness));
  const float interface =
                  coat * std::max(mean(glm::mix(1.0f - passingOut_.entering, metal, p_.metallic)), 1e-3f),
              cosine = coat * mean(remains * passingOut_.entering + multiple * passingOut_.lost),
              sum = 1 - coat + interface + cosine;
  chooseCoat_ = (1 - coat) / sum;
  chooseInterface_ = interface / sum;
  chooseCosine_ = cosine / sum;
}

Bsdf::Passing Bsdf::passing(float cosine) const {
  Passing p;
  const Albedo a = p_.dielectricAlbedo->at(cosine, p_.roughness);
  p.lost = std::max(1 - a.ofMirror(), 0.0f);
  const glm::vec3 albedo =
      reflected(p_.specularF0, glm::vec3(p_.specularF90), a) + dielectricMultiple_ * p.lost;
  p.entering = glm::max(1.0f - albedo, 0.0f);
  if (p_.clearcoat > 0) {
    const Albedo coat = p_.coatAlbedo->at(cosine, p_.clearcoatRoughness);
    p.coat = 1 - p_.clearcoat * (normalReflectance(kCoatIor) * coat.normal + coat.grazing);
  }
  return p;
}

glm::vec3 Bsdf::evaluate(glm::vec3 in) const {
  if (!(in.z > 0)) return glm::vec3(0);
  const glm::vec3 h = glm::normalize(in + out_);
  const float facing = glm::dot(in, h);
  const glm::vec3 dielectric =
                      glm::mix(p_.specularF0, glm::vec3(p_.specularF90), fresnelCurve(facing, p_.ior)),
                  metal = glm::mix(p_.baseColor, glm::vec3(1), schlickCurve(facing));
  const Passing passingIn = passing(in.z);
  glm::vec3 f = glm::mix(dielectric, metal, p_.metallic) * mirrorBrdf(in, out_, h, width_) +
                multiple_ * (passingIn.lost * passingOut_.lost) +
                diffuse_ * passingIn.entering * passingOut_.entering;
  f *= passingIn.coat * passingOut_.coat;
  if (p_.clearcoat > 0)
    f += p_.clearcoat * fresnelReflectance(facing, kCoatIor) * mirrorBrdf(in, out_, h, coatWidth_);
  return f * in.z;
}

float Bsdf::density(glm::vec3 in) const {
  if (!(in.z > 0)) return 0;
  const glm::vec3 h = glm::normalize(in + out_);
  float density = chooseCosine_ * in.z * kInversePi + chooseInterface_ * reflectionDensity(out_, h, width_);
  if (chooseCoat_ > 0) density += chooseCoat_ * reflectionDensity(out_, h, coatWidth_);
  return density;
}

std::optional<Bsdf::Sample> Bsdf::sample(float choice, float u, float v) const {
  Sample s;
  if (choice < chooseCosine_) {
    const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
    s.in = {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
  } else {
    const bool coat = choice >= chooseCosine_ + chooseInterface_;
    s.in = glm::reflect(-out_, sampleVisibleNormal(out_, coat ? coatWidth_ : width_, u, v));
  }
  s.density = density(s.in);
  if (!(s.density > 0)) return std::nullopt;
  s.weight = evaluate(s.in) / s.density;
  return s;
}

}  // namespace fovea::path_trace
