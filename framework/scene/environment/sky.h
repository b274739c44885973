// Clear daylight from formulas: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight"
// (SIGGRAPH 1999). Luminances are in kcd/m^2, illuminances in klx, as in the paper; the caller scales them.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// The range for which the paper gives the model: haze from the clearest sky up.
inline constexpr double kLeastTurbidity = 2, kMostTurbidity = 10;

// CIE xyY of the zenith (the paper's appendix A.2). sunAngle: radians between sun and zenith.
glm::vec3 zenithColor(float turbidity, float sunAngle);
// CIE xyY in a direction of the sky. angle: from the zenith, below pi / 2; fromSun: from the sun. Radians.
glm::vec3 skyColor(float turbidity, float sunAngle, float angle, float fromSun);
// Linear sRGB; the second component of (1/3, 1/3, Y) is about Y.
glm::vec3 linearFromXyY(glm::vec3 xyY);
// What of the sun's light reaches a surface that faces it, klx in the three channels of linear sRGB: the spectral
// attenuation by air, haze and ozone (the paper's appendix A.1) at 610, 550 and 465 nm.
glm::vec3 sunlight(float turbidity, float sunAngle);

glm::vec3 towardsSun(const Sky& sky);  // unit

struct Daylight {
  // Sky and ground, which both sun and sky light; the sun itself is not in it.
  std::shared_ptr<const EnvironmentMap> map;
  glm::vec3 sun{0};  // W/m^2 in each channel, on a surface that faces it
};
Daylight daylight(const Sky& sky);

// Makes it the environment of a scene, and its sun, if wanted, one of the lights.
void addDaylight(Scene& scene, const Sky& sky, bool withSun = true);

}  // namespace fovea::scene
