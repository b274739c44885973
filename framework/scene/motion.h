// Everything of a scene that changes with time, as a pure function of time: camera, gaze, lights, moving
// nodes.
#pragma once

#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

Camera cameraAt(const Scene& scene, double time);

// The sample in force at `time`: the last one at or before it that is valid. Linear between two valid
// neighbours would smear a saccade over the sampling interval, so samples hold.
GazeSample gazeAt(const std::vector<GazeSample>& gaze, double time);

std::vector<Light> lightsAt(const Scene& scene, double time);

MotionKey poseAt(const Mover& mover, double time);

// World transforms of nodes at any time.
class NodePoses {
 public:
  explicit NodePoses(const Scene& scene);
  struct Pose {
    glm::mat4 toWorld{1};
    bool visible = true;
  };
  Pose at(uint32_t node, double time) const;
  const Mover* moverOf(uint32_t node) const;  // of the node or of one above it; nullptr: none

 private:
  const Scene& scene_;
  std::vector<uint32_t> moverOfNode_;  // empty: nothing moves
};

// Of all objects of `geometry`, now and at the time `before`.
std::vector<ObjectTransform> objectsAt(const Scene& scene, const Geometry& geometry, double time,
                                       double before);

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  void include(glm::vec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
};
// Of all places that the box `mesh` of a node under `mover` comes to, whether visible there or not.
Bounds sweptBounds(const NodePoses& poses, uint32_t node, const Mover& mover, const Bounds& mesh);

}  // namespace fovea::scene
