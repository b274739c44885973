// Builds frames from a scene for one moment, and declares the interface through which a graph reaches the scene
// on the device.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <iterator>

#include "fovea/scene.h"

namespace fovea::scene {

// Field of view of a view that does not use a camera's: the tangents of the angles between the line of sight and the
// edges of the picture. Pixels need not be square.
struct Frustum {
  float left = 1, right = 1, up = 1, down = 1;
};
// Frustum of the left or the right eye of a display.
Frustum frustumOf(const Lens& lens, bool left);

// Makes a view of `size` pixels. If zFar of the camera is 0, it is taken from the scene's bounds.
View makeView(const Camera& camera, glm::uvec2 size, const Geometry& geometry,
              glm::vec2 gaze = glm::vec2(0.5f), const std::optional<Frustum>& frustum = {});

// Makes a view sample its pixels `now` pixels away from their centres (x right, y down); in the last frame the offset
// was `before`. This changes its matrices, including the previous one. (0, 0) leaves them as they are.
void jitter(View& view, glm::vec2 now, glm::vec2 before);

// Offset from the centre of the pixel in frame `index`, when `count` positions alternate: points of the Halton sequence
// of bases 2 and 3, shifted so that their mean is the centre. (0, 0) if `count` is less than 2.
glm::vec2 jitterAt(uint64_t index, uint32_t count);

// The views of every frame: the camera, and the two eyes, each half of Scene::ipd to the left or right of the camera,
// looking in the same direction, and through Scene::lens if the scene has one; and an inset in the picture of each eye,
// with half of its field each way, around the gaze, but within that picture.
inline constexpr const char* kViewNames[] = {"main", "left", "right", "left_inset", "right_inset"};
inline constexpr size_t kInsets[] = {3, 4};  // of these, and the eyes in whose pictures they lie
inline constexpr size_t kInsetEyes[] = {1, 2};

// These views with the size of the picture, or of the inset, in pixels, for binding a graph.
std::vector<std::pair<std::string, VkExtent2D>> frameViews(VkExtent2D size, VkExtent2D inset);

// Index in kViewNames. Throws Error(Internal) for another name.
size_t viewIndex(std::string_view name);

// An eye as a display has it, which need not follow from a camera: world space, relative to Scene::origin. It looks along
// its -Z, its +Y is up.
struct Eye {
  glm::vec3 position{0};  // metres
  glm::quat orientation{1, 0, 0, 0};
  Frustum frustum;
};
// Of each view; those that are not set follow from the camera.
using Eyes = std::array<std::optional<Eye>, std::size(kViewNames)>;

// Frames until Frame::saccade is 0 again.
inline constexpr uint32_t kSaccadeFrames = 8;

// Where each view's eye looks at `time`, by the scene; of insets, in the picture around them.
std::array<glm::vec2, std::size(kViewNames)> gazesAt(const Scene& scene, double time);

// The time, cameras and gaze of a frame. Those of a sequence follow from the scene; an interactive viewer changes them.
struct Moment {
  uint64_t index = 0;           // Frame::index
  double time = 0, before = 0;  // of this frame and of the last one, in seconds
  Camera camera, previousCamera;
  Eyes eyes, previousEyes;
  std::array<glm::vec2, std::size(kViewNames)> gazes{}, previousGazes{};  // of each view
  float saccade = 0;                                                      // Frame::saccade
  bool cameraCut = false;
};
// Frame `index` of a sequence at `framesPerSecond`.
Moment momentAt(const Scene& scene, uint64_t index, double framesPerSecond);

// size: of the pictures in pixels, also of insets unless their own is given. The gaze of an inset whose eye is not given
// is that of the picture around it; insets then follow it.
Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, const Moment& moment,
                uint32_t seed, const std::optional<glm::uvec2>& inset = {});
// Camera, eyes, gaze, lights and objects at frame `index` of a sequence at `framesPerSecond`; the paper's rate is 42
// Hz. The geometry is not changed: moveObjects() brings it to the frame.
Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond = 42.0);

// Moves the vertices of the dynamic objects to where Frame::objects has them; an invisible object collapses to a
// point. `geometry` must be what flatten() made of Frame::scene. Allocates nothing.
void moveObjects(const Frame& frame, Geometry& geometry);

// How the names of those bindings of set 1 begin that only rays use (shaders/rays).
inline constexpr const char* kRayBinding = "ray";

class HostScene;

// What a graph needs from the scene on the device: descriptor set 1, the same for every pass of a frame
// (shaders/scene/scene.glsl), and the vertices of everything that moves. `slot` is the number of a frame in flight.
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
  // The scene for kernels that run on the host, brought to this frame, whose geometry has moved already; nullptr if it
  // was not asked for.
  virtual const HostScene* host(const Frame&) { return nullptr; }
  // Records the commands that bring moving vertices to the frame with which the slot was updated. The caller's
  // barriers must order them (transfer and compute stages) after all earlier readers and before all later ones.
  virtual void recordMoves(VkCommandBuffer cmd, uint32_t slot) const = 0;
};

}  // namespace fovea::scene
