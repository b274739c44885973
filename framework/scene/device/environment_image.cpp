#include "framework/scene/device/environment_image.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/device.h"

namespace fovea::scene {

gpu::Image environmentImage(gpu::Device& device, const EnvironmentMap* map, float preExposure) {
  gpu::ImageDesc desc;
  desc.name = "environment";
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.width = map ? map->width() : 1;
  desc.height = map ? map->height() : 1;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (const uint32_t limit = device.limits().maxImageDimension2D; std::max(desc.width, desc.height) > limit)
    throw Error(ExitCode::BadInput,
                "the environment map of " + std::to_string(desc.width) + "x" + std::to_string(desc.height) +
                    " texels exceeds this device's maxImageDimension2D " + std::to_string(limit),
                "scale the map down");
  std::vector<glm::vec4> texels;
  if (map)
    for (const glm::vec3& t : map->texels()) texels.emplace_back(t * preExposure, 1);
  else
    texels.emplace_back(0);
  gpu::Image image(device, desc);
  gpu::upload(device, image, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  return image;
}

}  // namespace fovea::scene
