// What one frame looks at: views, gaze, lights and time. Passes get it through their context, not through
// globals.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
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
  glm::uvec2 size{0};        // pixels
  glm::vec2 gaze{0.5f};      // normalised image coordinates, origin top-left
  float verticalFov = 0.8f;  // radians, from the lower to the upper edge
  // World-space direction (not normalised) of the ray through image position p in pixels; pixel centres are
  // at +0.5.
  glm::vec3 rayDirection(glm::vec2 p) const;
};

// What a view sees, where that is not a camera's field of view: tangents of the angles between the line of
// sight and the edges of the picture. Pixels need not be square.
struct Frustum {
  float left = 1, right = 1, up = 1, down = 1;
};
// Of one eye of a display, the left or the right one.
Frustum frustumOf(const Lens& lens, bool left);

// zFar 0 in the camera: taken from the scene's bounds.
View makeView(const Camera& camera, glm::uvec2 size, const Geometry& geometry,
              glm::vec2 gaze = glm::vec2(0.5f), const std::optional<Frustum>& frustum = {});

// Where an object (index into Geometry::objects) is. An object's own space is that of its node's mesh; what
// is known of a point in it (VplState::localPosition) stays true while the object moves. Object 0 is all that
// never moves; its own space is the world's.
struct ObjectTransform {
  glm::mat4 toWorld{1}, previousToWorld{1};  // this frame's and the last one's; affine
  glm::mat4 toObject{1};                     // inverse of toWorld; zeros where there is none
  bool visible = true, previousVisible = true;
  // Its vertices move one by one (Object::deforms): a point of it keeps its place in a triangle instead.
  bool deforms = false;

  // The same as in shaders/common/scene.glsl.
  glm::vec3 fromObject(glm::vec3 position) const { return glm::vec3(toWorld * glm::vec4(position, 1)); }
  glm::vec3 intoObject(glm::vec3 position) const { return glm::vec3(toObject * glm::vec4(position, 1)); }
  glm::vec3 normalFromObject(glm::vec3 n) const {
    return glm::normalize(glm::transpose(glm::mat3(toObject)) * n);
  }
  glm::vec3 normalIntoObject(glm::vec3 n) const {
    return glm::normalize(glm::transpose(glm::mat3(toWorld)) * n);
  }
};

struct Frame {
  uint64_t index = 0;  // since the start of the sequence
  double time = 0;     // seconds
  uint32_t seed = 0;
  float exposure = 1;
  bool cameraCut = false;  // history of views is void
  std::vector<View> views;
  std::vector<Light> lights;
  std::vector<ObjectTransform> objects;  // as Geometry::objects
  // Of the objects that deform, this frame's and the last one's: the joints' world transforms times their
  // inverse bind matrices (Object::firstJoint), and the weights of morph targets (Object::firstWeight).
  std::vector<glm::mat4> joints, previousJoints;
  std::vector<float> weights, previousWeights;
  const Scene* scene = nullptr;
  const Geometry* geometry = nullptr;  // world space, this frame
  GpuScene* gpu = nullptr;

  const View* findView(std::string_view name) const;
};

// The views of every frame: the camera, and the two eyes half of Scene::ipd to its left and right, looking
// the same way, through Scene::lens where there is one.
inline constexpr const char* kViewNames[] = {"main", "left", "right"};

// Camera, eyes, gaze, lights and objects at frame `index` of a sequence at `framesPerSecond` (42 Hz is the
// paper's). The geometry is not touched: moveObjects() brings it to the frame.
Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond = 42.0);

// Vertices of the dynamic objects as Frame::objects has them; what is invisible collapses to a point.
// `geometry` is flatten()'s for Frame::scene. Allocates nothing.
void moveObjects(const Frame& frame, Geometry& geometry);

}  // namespace fovea::scene
