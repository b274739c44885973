#include "framework/scene/tables/albedos.h"

#include <cmath>

#include "shaders/records/scene.h"

#include "shaders/device/language.h"

namespace fovea::scene {
namespace {

using namespace glm;
#include "shaders/materials/microfacets.glsl"

constexpr int kSamples = 1024;  // of an entry
constexpr int kSteps = 512;     // of an integral over the cosine

// Fresnel's equations for unpolarised light that arrives from outside, between F0 and F90. cosine: above 0.
float exactCurve(float cosine, float ior) {
  const float inside = sqrt(ior * ior - 1.0 + cosine * cosine);  // the cosine there, times ior
  const float s = (cosine - inside) / (cosine + inside),
              p = (inside - ior * ior * cosine) / (inside + ior * ior * cosine);
  const float root = (ior - 1.0) / (ior + 1.0), f0 = root * root;
  return max((0.5 * (s * s + p * p) - f0) / (1.0 - f0), 0.0);
}

// Mean over visible normals; each is worth F * G2 / G1 (Heitz 2018, Eq. 19). The random numbers are a Fibonacci lattice:
// most of what little light is lost is lost near its edge.
vec4 integrate(float cosine, float roughness) {
  const float alpha = ggxAlpha(roughness);
  const vec3 eye(sqrt(max(1.0 - cosine * cosine, 0.0)), 0.0, cosine);
  const float lambda = smithLambda(eye, alpha);
  dvec3 sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    const vec3 h =
        sampleVisibleNormal(eye, alpha, vec2((float(i) + 0.5) / kSamples, fract(float(i) * 0.61803399)));
    const float facing = dot(eye, h);
    const vec3 light = 2.0 * facing * h - eye;
    if (light.z <= 0.0) continue;
    const float visible = (1.0 + lambda) / (1.0 + lambda + smithLambda(light, alpha));
    sum += dvec3(visible * vec3(1.0, fresnelCurve(facing, 1.0), exactCurve(facing, 1.5)));
  }
  return vec4(sum / double(kSamples), 0.0);
}

std::vector<vec4> integrateAll() {
  const auto share = [](uint32_t i) { return float(i) / float(kAlbedoSide - 1); };
  std::vector<vec4> table, means;
  for (uint32_t row = 0; row < kAlbedoSide; ++row) {
    const size_t first = table.size();
    for (uint32_t column = 0; column < kAlbedoSide; ++column) {
      const float root = mix(kAlbedoLeastRoot, 1.0, share(column));
      table.push_back(integrate(root * root, share(row)));
    }
    dvec4 mean(0.0);
    for (int i = 0; i < kSteps; ++i) {
      const float cosine = (float(i) + 0.5) / kSteps;
      const float x = clamp((sqrt(cosine) - kAlbedoLeastRoot) / (1.0 - kAlbedoLeastRoot), 0.0, 1.0) *
                      float(kAlbedoSide - 1);
      const size_t column = min(uint32_t(x), kAlbedoSide - 2);
      mean += dvec4(mix(table[first + column], table[first + column + 1], x - float(column)) *
                    (2.0 * cosine / kSteps));
    }
    means.emplace_back(mean);
  }
  table.insert(table.end(), means.begin(), means.end());
  return table;
}

}  // namespace

const std::vector<vec4>& lobeAlbedos() {
  static const std::vector<vec4> table = integrateAll();
  return table;
}

}  // namespace fovea::scene
