// The lobe in which a surface that the eye sees reflects light, as the G-buffer keeps it; the same as
// passes/near-field-device/receiver_lobe.glsl.
#pragma once

#include <glm/glm.hpp>

namespace fovea::passes {

class ReceiverLobe {
 public:
  ReceiverLobe() = default;  // reflects light as the diffuse layer does
  // normal, specular: texels of the G-buffer, with full materials; toEye: unit.
  ReceiverLobe(glm::vec4 normal, glm::vec4 specular, glm::vec3 toEye);

  // What light from a direction, which is unit, adds to the mean of the light under the lobe for each unit of
  // irradiance / pi that it adds. cosine: by which that irradiance counts; its normal may not be that of shading.
  float response(glm::vec3 direction, float cosine) const;

 private:
  glm::mat3 frame_{1};  // of the shading normal
  glm::vec3 out_{0};    // to the eye, in that frame
  float roughness_ = 1;
  // Factors on what microfacets reflect of light that they scatter once, and on what they lose of it and scatter more
  // than once; both 0 if there is no lobe.
  float once_ = 0, more_ = 0;
};

}  // namespace fovea::passes
