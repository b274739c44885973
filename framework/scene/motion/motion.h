// Everything of a scene that changes with time, as a pure function of time: camera, gaze, lights, moving
// nodes.
#pragma once

#include <filesystem>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// The camera path; without one the first camera, which goes where its node goes.
Camera cameraAt(const Scene& scene, double time);

// Samples of an eye tracker that lie further apart, in time or in the picture, are not joined.
inline constexpr double kGazeGap = 0.05;   // s; slower trackers, pauses and blinks
inline constexpr float kGazeJump = 0.05f;  // parts of the image; saccades

// Where the eye looks at `time`: at the last valid sample at or before it (before all of them: at the first
// one). Within a fixation or a slow pursuit linear to the next sample: when that is valid, follows at most
// `gap` after it and lies no further than kGazeJump off. A saccade is never smeared over the interval between
// two samples; a blink or a pause of the tracker holds what was before it.
GazeSample gazeAt(const std::vector<GazeSample>& gaze, double time, double gap = kGazeGap);

// A table of samples, see samples/scenes/README.md. Throws Error(BadInput) with the file and the line of
// every mistake.
std::vector<GazeSample> readGazeCsv(const std::filesystem::path& file);

std::vector<Light> lightsAt(const Scene& scene, double time);

MotionKey poseAt(const Mover& mover, double time);

// World transforms of nodes at any time: what a mover says, else what a playing animation says, else the
// node's own.
class NodePoses {
 public:
  explicit NodePoses(const Scene& scene);
  struct Pose {
    glm::mat4 toWorld{1};
    bool visible = true;
  };
  Pose at(uint32_t node, double time) const;
  const Mover* moverOf(uint32_t node) const;  // of the node or of one above it; nullptr: none
  bool animated(uint32_t node) const;         // a channel moves it or one above it, or shapes its mesh
  bool moves(uint32_t node) const;            // a mover or a channel moves the node itself
  bool reshapes(uint32_t node) const;         // a channel sets the weights of its mesh's morph targets
  // Of the node's morph targets (morphTargets() of them).
  std::vector<float> weightsAt(uint32_t node, double time) const;
  // World transforms of the joints of the node's skin times their inverse bind matrices, appended.
  void jointsAt(uint32_t node, double time, std::vector<glm::mat4>& joints) const;
  // Seconds from 0 in which all that acts on the node's vertices has run through its keys, and the times to
  // look at it: all keys of animations and kSteps between neighbours, at least.
  std::vector<double> sampleTimes(uint32_t node) const;

 private:
  struct Channel {
    const Animation* animation;
    const AnimationChannel* channel;
  };
  glm::mat4 localAt(uint32_t node, double time, bool& visible) const;
  template <class Visit>
  void eachAbove(uint32_t node, const Visit& visit) const;  // the node, those above it, its joints, theirs

  const Scene& scene_;
  std::vector<uint32_t> moverOfNode_;           // empty: no movers
  std::vector<std::vector<Channel>> channels_;  // of each node; empty: nothing plays
};

// Of all objects of `geometry`, now and at the time `before`; as the members of Frame.
struct ObjectPoses {
  std::vector<ObjectTransform> objects;
  std::vector<glm::mat4> joints, previousJoints;
  std::vector<float> weights, previousWeights;
};
ObjectPoses objectsAt(const Scene& scene, const Geometry& geometry, double time, double before);

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  void include(glm::vec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
};
// Of all places that the box `mesh` of a node under `mover` comes to, whether visible there or not.
Bounds sweptBounds(const NodePoses& poses, uint32_t node, const Mover& mover, const Bounds& mesh);

// Of all places that the vertices of an object that animations move or deform come to. Looked at in
// NodePoses::sampleTimes(), and wider by a quarter of what the box grows or shrinks between two of them.
Bounds animatedBounds(const Scene& scene, const NodePoses& poses, const Object& object);

}  // namespace fovea::scene
