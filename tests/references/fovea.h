// The fovea on the image plane, the weight of a pixel, and random pixels in the fovea, as a plain reference for
// shaders/sampling/fovea.glsl.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "framework/base/random.h"
#include "framework/scene/fovea.h"
#include "passes/regions.h"
#include "shaders/records/fovea.h"

namespace fovea::scene {

// Foveated weight of an image position: 1 inside r_f, r_f / r outside.
inline float foveaWeight(const Fovea& fovea, glm::vec2 position) {
  const float r = glm::distance(position, fovea.centre);
  return r <= fovea.radius ? 1.0f : fovea.radius / r;
}

inline glm::vec2 streamPoint(uint32_t stream, uint32_t draw) {
  return {uniformFloat(hashCombine(stream, draw)), uniformFloat(hashCombine(stream, draw + 1u))};
}

// A random pixel, uniform over the part of the disc inside the image, or over the whole image if `region` says so or
// the disc lies outside the image.
inline glm::ivec2 regionSample(uint32_t region, const Fovea& fovea, glm::ivec2 imageSize, uint32_t stream) {
  const glm::vec2 low(0.0f), high(imageSize);
  const glm::vec2 off = glm::max(glm::max(-fovea.centre, fovea.centre - high), glm::vec2(0.0f));
  const float radius2 = fovea.radius * fovea.radius;
  const glm::vec2 across(off.y, off.x);
  const glm::vec2 reach = glm::sqrt(glm::max(radius2 - across * across, glm::vec2(0.0f)));
  if (region == kRegionFovea && glm::dot(off, off) < radius2) {
    const glm::vec2 boxLow = glm::max(low, fovea.centre - reach),
                    boxHigh = glm::min(high, fovea.centre + reach);
    for (uint32_t i = 0; i < kRegionTries; ++i) {
      const glm::vec2 position = glm::mix(boxLow, boxHigh, streamPoint(stream, 2u * i)),
                      d = position - fovea.centre;
      if (glm::dot(d, d) <= radius2) return glm::clamp(glm::ivec2(position), glm::ivec2(0), imageSize - 1);
    }
  }
  const glm::vec2 position = high * streamPoint(stream, 2u * kRegionTries);
  return glm::clamp(glm::ivec2(position), glm::ivec2(0), imageSize - 1);
}

// Pixel of point i of the `points` fixed points on screen from which the density of lights is estimated; the same
// points as those of the shader that does so. share64ths: share of the points taken from the whole image for
// `kRegionMixed`, in 64ths.
inline glm::ivec2 screenPoint(uint32_t region, uint32_t share64ths, uint32_t i, uint32_t points,
                              const Fovea& fovea, glm::ivec2 imageSize) {
  constexpr uint32_t kPointsStream = 0x77656967u;
  const auto sequence = [](uint32_t k) {
    return glm::vec2(uniformFloat(0x80000000u + k * 3242174889u),
                     uniformFloat(0x80000000u + k * 2447445414u));
  };
  const uint32_t before = i * share64ths >> 6;
  const bool mixed = region == kRegionMixed, image = (i + 1) * share64ths >> 6 != before;
  const uint32_t part = !mixed ? region : image ? kRegionImage : kRegionFovea;
  const uint32_t number = !mixed ? i : image ? before : i - before;
  const glm::vec2 high(imageSize);
  if (part == kRegionImage)
    return glm::clamp(glm::ivec2(high * sequence(number)), glm::ivec2(0), imageSize - 1);
  const glm::vec2 off = glm::max(glm::max(-fovea.centre, fovea.centre - high), glm::vec2(0.0f));
  const float radius2 = fovea.radius * fovea.radius;
  const glm::vec2 across(off.y, off.x),
      reach = glm::sqrt(glm::max(radius2 - across * across, glm::vec2(0.0f)));
  const glm::vec2 boxLow = glm::max(glm::vec2(0.0f), fovea.centre - reach),
                  boxHigh = glm::min(high, fovea.centre + reach);
  for (uint32_t k = 0; glm::dot(off, off) < radius2 && k < kRegionTries; ++k) {
    const glm::vec2 position = glm::mix(boxLow, boxHigh, sequence(number + k * points)),
                    d = position - fovea.centre;
    if (glm::dot(d, d) <= radius2) return glm::clamp(glm::ivec2(position), glm::ivec2(0), imageSize - 1);
  }
  return regionSample(part, fovea, imageSize, randomStream(0u, 0u, kPointsStream, number));
}

}  // namespace fovea::scene
