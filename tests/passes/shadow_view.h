// A second derivation of the projections of shadow maps, for the tests.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "shaders/records/shadow.h"

namespace fovea::test {

using scene::kMaxShadowLayers;
using scene::ShadowView;

// Looks from `eye` along `forward`; the depth is near / distance along it.
inline ShadowView perspectiveView(glm::vec3 eye, glm::vec3 forward, float tanHalf, float near, int size) {
  const glm::vec3 up = glm::normalize(
      glm::cross(forward, std::abs(forward.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)));
  const glm::vec3 right = glm::cross(up, forward);
  ShadowView v;
  for (int c = 0; c < 4; ++c) {
    auto dot = [&](glm::vec3 axis) { return c < 3 ? axis[c] : -glm::dot(axis, eye); };
    v.worldToClip[c] = {dot(right) / tanHalf, dot(up) / tanHalf, c < 3 ? 0 : near, dot(forward)};
  }
  v.right = right;
  v.up = up;
  v.texelWidth = v.texelHeight = 2 * tanHalf / size;
  v.relativeBias = 1e-4f;
  v.depthScale = near;
  return v;
}

// A cube of half side `half` around `centre`, seen along `forward`; the depth falls from 1 to 0.
inline ShadowView orthographicView(glm::vec3 centre, glm::vec3 forward, float half, int size) {
  ShadowView v = perspectiveView(centre, forward, half, 1, size);
  for (int c = 0; c < 4; ++c) {
    const float along = c < 3 ? forward[c] : -glm::dot(forward, centre);
    v.worldToClip[c].z = -0.5f * along / half + (c < 3 ? 0 : 0.5f);
    v.worldToClip[c].w = c < 3 ? 0 : 1;
  }
  v.bias = 1e-5f;
  v.relativeBias = 0;
  v.depthScale = 0.5f / half;
  return v;
}

}  // namespace fovea::test
