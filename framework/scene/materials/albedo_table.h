// What a rough surface reflects in all directions together, tabulated.
#pragma once

#include <array>
#include <functional>

namespace fovea::scene {

// The directional albedo of the GGX microfacet model with single scattering, for a Fresnel reflection
// F0 + (F90 - F0) * curve(cosine): it is F0 * low + F90 * high ("split sum", Karis 2013).
struct Albedo {
  float low = 0, high = 0;
  float total() const { return low + high; }  // of a perfect mirror
};

class AlbedoTable {
 public:
  // curve: rises from 0 at cosine 1 to 1 at cosine 0. Takes some hundredths of a second.
  explicit AlbedoTable(const std::function<float(float)>& curve);

  // cosine: between the direction and the normal. roughness: perceptual. Both within [0, 1].
  Albedo at(float cosine, float roughness) const;
  // Mean over the directions, weighted by their cosine: what is reflected of diffuse light.
  Albedo average(float roughness) const;
  // The same mean of the curve itself.
  float averageCurve() const { return averageCurve_; }

  // That of Schlick's approximation, for metals, and that of a dielectric whose index of refraction is within 1.1% of
  // `ior`, 1.5 exactly: the curve changes little with it. Made at the first request and kept; thread-safe.
  static const AlbedoTable& schlick();
  static const AlbedoTable& dielectric(float ior);

 private:
  static constexpr size_t kSide = 48;
  std::array<Albedo, kSide * kSide>
      entries_;  // rows of equal roughness; columns of equal square root of the cosine
  std::array<Albedo, kSide> averages_;
  float averageCurve_ = 0;
};

}  // namespace fovea::scene
