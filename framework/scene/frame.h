// What one frame looks at: views, gaze, lights and time. Passes get it through their context, not through globals.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

class GpuScene;

// One eye. Clip space is Vulkan's: x right, y down, depth 0 at the near plane and 1 at the far plane.
struct View {
  std::string name = "main";
  glm::mat4 worldToView{1}, viewToClip{1}, worldToClip{1}, clipToWorld{1};
  glm::mat4 previousWorldToClip{1};
  glm::vec3 eye{0};
  glm::uvec2 size{0};       // pixels
  glm::vec2 gaze{0.5f};     // normalised image coordinates, origin top-left
  float verticalFov = 0.8f;  // radians
  // World-space direction (not normalised) of the ray through image position p in pixels; pixel centres are at +0.5.
  glm::vec3 rayDirection(glm::vec2 p) const;
};

// zFar 0 in the camera: taken from the scene's bounds.
View makeView(const Camera& camera, glm::uvec2 size, const Geometry& geometry, glm::vec2 gaze = glm::vec2(0.5f));

struct Frame {
  uint64_t index = 0;      // since the start of the sequence
  double time = 0;         // seconds
  uint32_t seed = 0;
  float exposure = 1;
  bool cameraCut = false;  // history of views is void
  std::vector<View> views;
  std::vector<Light> lights;
  const Scene* scene = nullptr;
  const Geometry* geometry = nullptr;  // world space, this frame
  GpuScene* gpu = nullptr;

  const View* findView(std::string_view name) const;
};

// Camera, gaze and lights at frame `index` of a sequence at `framesPerSecond` (42 Hz is the paper's).
Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond = 42.0);

}  // namespace fovea::scene
