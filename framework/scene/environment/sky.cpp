#include "framework/scene/environment/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace fovea::scene {
namespace {

constexpr uint32_t kWidth = 512,
                   kHeight = 256;         // of the map; the glow around the sun is the finest thing in it
constexpr float kSolarIlluminance = 128;  // klx, outside the atmosphere

// Perez et al. 1993, Eq. 3 of the paper.
struct Perez {
  float a, b, c, d, e;
  float at(float angle, float fromSun) const {
    const float cosine = std::max(std::cos(angle), 1e-4f), cosineSun = std::cos(fromSun);
    return (1 + a * std::exp(b / cosine)) * (1 + c * std::exp(d * fromSun) + e * cosineSun * cosineSun);
  }
  // Relative to the zenith.
  float relative(float sunAngle, float angle, float fromSun) const {
    return at(angle, fromSun) / at(0, sunAngle);
  }
};

Perez perezX(float t) {
  return {-0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
          -0.0033f * t + 0.0452f};
}
Perez perezY(float t) {
  return {-0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
          -0.0109f * t + 0.0529f};
}
Perez perezLuminance(float t) {
  return {0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
          -0.0670f * t + 0.3703f};
}

// (T^2, T, 1) times a matrix times (angle^3, angle^2, angle, 1), given by the rows of the matrix.
float zenithChromaticity(float t, float angle, const float (&m)[3][4]) {
  const auto row = [&](const float(&r)[4]) { return ((r[0] * angle + r[1]) * angle + r[2]) * angle + r[3]; };
  return (row(m[0]) * t + row(m[1])) * t + row(m[2]);
}

float mean(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

// Of one channel's sunlight. The mass of air multiplies the absorption, as in Iqbal, "An Introduction to Solar
// Radiation" (1983), from which the paper quotes it within the exponent of the wavelength. wavelength: um; ozone:
// absorption per cm.
float transmittance(float turbidity, float sunAngle, float wavelength, float ozone) {
  constexpr float kOzone = 0.35f, kHaze = 1.3f;  // cm; exponent of the haze's particles
  const float degrees = glm::degrees(sunAngle);
  const float mass = 1 / (std::max(std::cos(sunAngle), 0.0f) + 0.15f * std::pow(93.885f - degrees, -1.253f));
  const float air = 0.008735f * std::pow(wavelength, -4.08f),
              haze = (0.04608f * turbidity - 0.04586f) * std::pow(wavelength, -kHaze);
  return std::exp(-(air + haze + ozone * kOzone) * mass);
}

}  // namespace

glm::vec3 zenithColor(float turbidity, float sunAngle) {
  static constexpr float kX[3][4] = {{0.00166f, -0.00375f, 0.00209f, 0},
                                     {-0.02903f, 0.06377f, -0.03202f, 0.00394f},
                                     {0.11693f, -0.21196f, 0.06052f, 0.25886f}};
  static constexpr float kY[3][4] = {{0.00275f, -0.00610f, 0.00317f, 0},
                                     {-0.04214f, 0.08970f, -0.04153f, 0.00516f},
                                     {0.15346f, -0.26756f, 0.06670f, 0.26688f}};
  const float chi = (4.0f / 9 - turbidity / 120) * (glm::pi<float>() - 2 * sunAngle);
  const float luminance = (4.0453f * turbidity - 4.9710f) * std::tan(chi) - 0.2155f * turbidity + 2.4192f;
  return {zenithChromaticity(turbidity, sunAngle, kX), zenithChromaticity(turbidity, sunAngle, kY),
          std::max(luminance, 0.0f)};
}

glm::vec3 skyColor(float turbidity, float sunAngle, float angle, float fromSun) {
  return zenithColor(turbidity, sunAngle) *
         glm::vec3(perezX(turbidity).relative(sunAngle, angle, fromSun),
                   perezY(turbidity).relative(sunAngle, angle, fromSun),
                   perezLuminance(turbidity).relative(sunAngle, angle, fromSun));
}

glm::vec3 linearFromXyY(glm::vec3 xyY) {
  const glm::vec3 xyz = xyY.z / xyY.y * glm::vec3(xyY.x, xyY.y, 1 - xyY.x - xyY.y);
  return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
          -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
          0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

glm::vec3 sunlight(float turbidity, float sunAngle) {
  return kSolarIlluminance * glm::vec3(transmittance(turbidity, sunAngle, 0.61f, 0.12f),
                                       transmittance(turbidity, sunAngle, 0.55f, 0.085f),
                                       transmittance(turbidity, sunAngle, 0.465f, 0.008f));
}

glm::vec3 towardsSun(const Sky& sky) {
  const float across = std::cos(sky.sunElevation);
  return {-across * std::sin(sky.sunAzimuth), std::sin(sky.sunElevation), -across * std::cos(sky.sunAzimuth)};
}

Daylight daylight(const Sky& sky) {
  const float sunAngle = glm::half_pi<float>() - sky.sunElevation;
  const glm::vec3 sun = towardsSun(sky);
  Daylight light;
  light.sun = sunlight(sky.turbidity, sunAngle);
  glm::vec3 onGround = std::max(sun.y, 0.0f) * light.sun;  // irradiance
  std::vector<glm::vec3> texels(size_t(kWidth) * kHeight);
  const float step = glm::pi<float>() / float(kHeight), turn = glm::two_pi<float>() / float(kWidth);
  for (uint32_t y = 0; y < kHeight / 2; ++y) {
    const float angle = (float(y) + 0.5f) * step;
    for (uint32_t x = 0; x < kWidth; ++x) {
      const float around = (float(x) + 0.5f) * turn - glm::pi<float>();
      const glm::vec3 direction(std::sin(angle) * std::sin(around), std::cos(angle),
                                -std::sin(angle) * std::cos(around));
      const float fromSun = std::acos(std::clamp(glm::dot(direction, sun), -1.0f, 1.0f));
      glm::vec3& texel = texels[size_t(y) * kWidth + x];
      texel = glm::max(linearFromXyY(skyColor(sky.turbidity, sunAngle, angle, fromSun)), 0.0f);
      onGround += texel * (std::cos(angle) * std::sin(angle) * step * turn);
    }
  }
  const float scale = sky.illuminance / mean(onGround);
  light.sun *= scale;
  for (glm::vec3& t : texels) t *= scale;
  std::fill(texels.begin() + ptrdiff_t(texels.size() / 2), texels.end(),
            scale * sky.ground * onGround * glm::one_over_pi<float>());
  light.map = std::make_shared<const EnvironmentMap>(kWidth, kHeight, std::move(texels));
  return light;
}

void addDaylight(Scene& scene, const Sky& sky, bool withSun) {
  const Daylight light = daylight(sky);
  scene.environmentMap = light.map;
  if (!withSun) return;
  Light sun;
  sun.name = "sun";
  sun.color = light.sun;
  sun.direction = -towardsSun(sky);
  scene.lights.push_back(sun);
}

}  // namespace fovea::scene
