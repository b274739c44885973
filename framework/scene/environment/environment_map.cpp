#include "framework/scene/environment/environment_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "fovea/image.h"

namespace fovea::scene {
namespace {

float brightness(glm::vec3 radiance) { return (radiance.r + radiance.g + radiance.b) / 3; }

// Makes the values of a part of a list cumulative, so that the last is 1; returns their sum. Values that are all 0 stay.
double accumulate(std::vector<float>::iterator begin, std::vector<float>::iterator end) {
  double sum = 0;
  for (auto i = begin; i != end; ++i) sum += double(*i);
  if (!(sum > 0)) return 0;
  double part = 0;
  for (auto i = begin; i != end; ++i) *i = float((part += double(*i)) / sum);
  *(end - 1) = 1;
  return sum;
}

}  // namespace

EnvironmentMap::EnvironmentMap(uint32_t width, uint32_t height, std::vector<glm::vec3> texels, float turn)
    : width_(width),
      height_(height),
      texels_(std::move(texels)),
      turn_(turn),
      columns_(texels_.size()),
      rows_(height) {
  for (glm::vec3& t : texels_)
    for (int c = 0; c < 3; ++c) t[c] = std::isfinite(t[c]) ? std::max(t[c], 0.0f) : 0.0f;
  // The mean of the interpolated light over a texel, in which its neighbours have a part.
  constexpr float kWeights[] = {1 / 8.f, 6 / 8.f, 1 / 8.f};
  for (uint32_t y = 0; y < height; ++y) {
    const auto row = columns_.begin() + ptrdiff_t(size_t(y) * width);
    for (uint32_t x = 0; x < width; ++x)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          row[x] += kWeights[dx + 1] * kWeights[dy + 1] * brightness(texel(int(x) + dx, int(y) + dy));
    rows_[y] = float(accumulate(row, row + width) * double(solidAngle(y)));
  }
  accumulate(rows_.begin(), rows_.end());
}

const glm::vec3& EnvironmentMap::texel(int x, int y) const {
  x = (x + int(width_)) % int(width_);
  return texels_[size_t(std::clamp(y, 0, int(height_) - 1)) * width_ + size_t(x)];
}

float EnvironmentMap::solidAngle(uint32_t row) const {
  const float step = glm::pi<float>() / float(height_);
  return glm::two_pi<float>() / float(width_) * 2 * std::sin(0.5f * step) *
         std::sin((float(row) + 0.5f) * step);
}

EnvironmentMap::Place EnvironmentMap::placeOf(glm::vec3 direction) const {
  const float around = (std::atan2(direction.x, -direction.z) + turn_) / glm::two_pi<float>() + 0.5f;
  return {(around - std::floor(around)) * float(width_),
          std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / glm::pi<float>() * float(height_)};
}

glm::vec3 EnvironmentMap::radiance(glm::vec3 direction) const {
  const Place p = placeOf(direction);
  const float left = std::floor(p.x - 0.5f), top = std::floor(p.y - 0.5f);
  const float fx = p.x - 0.5f - left, fy = p.y - 0.5f - top;
  const int x = int(left), y = int(top);
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), fx),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), fx), fy);
}

std::shared_ptr<const EnvironmentMap> loadEnvironment(const std::filesystem::path& file, float intensity,
                                                      float turn) {
  const image::File content = image::read(file);
  const image::Layer& layer = content.layers.front();
  const image::Image& picture = layer.image;
  if (layer.data != layer.display)
    throw Error(ExitCode::BadInput, file.string() + ": its data window is not its display window",
                "give all pixels of the map, and no others");
  if (picture.channels < 3 || picture.width != 2 * picture.height)
    throw Error(ExitCode::BadInput,
                file.string() + ": an environment is a colour image twice as wide as high, this one is " +
                    std::to_string(picture.width) + "x" + std::to_string(picture.height) + " with " +
                    std::to_string(picture.channels) + " channels",
                "give an equirectangular map in linear radiance (.exr, .hdr, .pfm)");
  std::vector<glm::vec3> texels(size_t(picture.width) * picture.height);
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x)
      texels[size_t(y) * picture.width + x] =
          intensity * glm::vec3(picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2));
  return std::make_shared<const EnvironmentMap>(picture.width, picture.height, std::move(texels), turn);
}

}  // namespace fovea::scene
