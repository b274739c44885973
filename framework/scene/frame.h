// Frames: made from a scene for one moment, and the interface through which a graph reaches the scene on the device.
#pragma once

#include <vulkan/vulkan.h>

#include "fovea/scene.h"

namespace fovea::scene {

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

// The views of every frame: the camera, and the two eyes half of Scene::ipd to its left and right, looking
// the same way, through Scene::lens where there is one.
inline constexpr const char* kViewNames[] = {"main", "left", "right"};

// These views, each as large as the picture: what a graph over such frames is bound to.
std::vector<std::pair<std::string, VkExtent2D>> frameViews(VkExtent2D size);

// Camera, eyes, gaze, lights and objects at frame `index` of a sequence at `framesPerSecond` (42 Hz is the
// paper's). The geometry is not touched: moveObjects() brings it to the frame.
Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond = 42.0);

// Vertices of the dynamic objects as Frame::objects has them; what is invisible collapses to a point.
// `geometry` is flatten()'s for Frame::scene. Allocates nothing.
void moveObjects(const Frame& frame, Geometry& geometry);

// What a graph needs of the scene on the device: descriptor set 1, the same for every pass of a frame
// (shaders/common/scene.glsl), and the vertices of what moves. `slot` numbers the frames in flight.
class FrameDescriptors {
 public:
  virtual ~FrameDescriptors() = default;
  virtual VkDescriptorSetLayout setLayout() const = 0;
  virtual VkDescriptorSet set(uint32_t slot) const = 0;
  // Dynamic offset of binding 1, the view, for Frame::views[view].
  virtual uint32_t viewOffset(uint32_t view) const = 0;
  // Writes this frame's uniforms into the slot. Neither waits for the device nor allocates.
  virtual void update(const Frame& frame, uint32_t slot) = 0;
  virtual bool moves() const = 0;  // whether recordMoves() does anything
  // Brings the vertices of what moves to the frame that the slot was updated with. The caller's barriers keep it
  // (transfer and compute stages) behind all earlier readers and before all later ones.
  virtual void recordMoves(VkCommandBuffer cmd, uint32_t slot) const = 0;
};

}  // namespace fovea::scene
