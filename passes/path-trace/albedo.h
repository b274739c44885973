// What rough interfaces reflect in all directions together.
#pragma once

#include <array>
#include <functional>

namespace fovea::path_trace {

// Of GGX microfacets that scatter light once, with the Fresnel reflection F0 + (F90 - F0) * curve(cosine): they reflect
// F0 * normal + F90 * grazing.
struct Albedo {
  float normal = 0, grazing = 0;
  float ofMirror() const { return normal + grazing; }
};

// Albedos by cosine of the incident light and perceptual roughness, both within [0, 1].
class AlbedoTable {
 public:
  // curve: from 0 at cosine 1 to 1 at cosine 0. Takes a tenth of a second.
  explicit AlbedoTable(const std::function<float(float)>& curve);
  Albedo at(float cosine, float roughness) const;
  // Means over the directions, weighted by their cosine: for diffuse light.
  Albedo mean(float roughness) const;
  float meanCurve() const { return meanCurve_; }

  // Made when they are first asked for, and kept; thread-safe. Metals have Schlick's curve; the index of refraction of
  // a dielectric is rounded to a multiple of 0.02 of at most 8, which changes little, so that few tables are needed.
  static const AlbedoTable& schlick();
  static const AlbedoTable& dielectric(float ior);

 private:
  static constexpr size_t kSide = 48;
  std::array<std::array<Albedo, kSide>, kSide> table_;  // rows of equal roughness, by square root of cosine
  std::array<Albedo, kSide> means_;
  float meanCurve_ = 0;
};

}  // namespace fovea::path_trace
