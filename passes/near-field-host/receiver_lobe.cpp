#include "passes/near-field-host/receiver_lobe.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "framework/scene/materials/albedo_table.h"
#include "framework/scene/materials/bsdf.h"
#include "framework/scene/materials/microfacets.h"
#include "framework/shader_twins/paraboloid.h"
#include "shaders/records/mirror.h"
#include "shaders/records/near_field.h"

namespace fovea::passes {

ReceiverLobe::ReceiverLobe(glm::vec4 normal, glm::vec4 specular, glm::vec3 toEye) {
  const float most = std::max({specular.r, specular.g, specular.b});
  if (!(most > 0)) return;
  frame_ = scene::orthonormalFrame(glm::normalize(glm::vec3(normal)));
  out_ = scene::toLocal(frame_, toEye);
  out_ = glm::normalize(glm::vec3(out_.x, out_.y, std::max(out_.z, kLeastLobe)));
  // What is smoother than this is traced (pass mirrors).
  roughness_ = std::max(specular.a, most > kMetallicF0 ? kTracedMetal : kTracedDielectric);
  const float once = scene::AlbedoTable::schlick().at(out_.z, roughness_).total();
  const float mean = scene::AlbedoTable::schlick().average(roughness_).total();
  // As in gloss.glsl, with the mean of the channels for a reflectance that is the same from everywhere.
  const float fresnel = std::min((specular.r + specular.g + specular.b) / 3, 1.0f);
  const float more = scene::lostAlbedo(glm::vec3(fresnel), mean).x * (1 - once);
  const float all = std::max(fresnel * once + more, kLeastLobe * fresnel);
  once_ = glm::pi<float>() * fresnel / all;
  more_ = more / (all * std::max(1 - mean, kLeastLobe));
}

float ReceiverLobe::response(glm::vec3 direction, float cosine) const {
  if (once_ == 0) return 1;
  const glm::vec3 in = scene::toLocal(frame_, direction);
  if (in.z <= 0) return 0;
  const float reflects =
      once_ * scene::ggxReflection(in, out_, glm::normalize(in + out_), scene::ggxAlpha(roughness_)) +
      more_ * (1 - scene::AlbedoTable::schlick().at(in.z, roughness_).total());
  return reflects * in.z / std::max(cosine, kLeastReceived);
}

}  // namespace fovea::passes
