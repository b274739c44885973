// Everything in a scene that changes with time, as a pure function of time: camera, gaze, lights and moving nodes.
#pragma once

#include <filesystem>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// The camera on its path or, without a path, the first camera, which moves with its node.
Camera cameraAt(const Scene& scene, double time);

// Consecutive samples of an eye tracker are not joined if they lie further apart than this in the image, or than
// kGazeGap in time.
inline constexpr float kGazeJump = 0.05f;  // normalised image coordinates; exceeded by saccades

// Gaze at `time`: the last valid sample at or before it, or the first one if `time` precedes them all. The gaze is
// interpolated linearly to the next sample, as within a fixation or a slow pursuit, if that sample is valid, follows
// by at most `gap` and lies no further than kGazeJump away. Hence a saccade is never smeared over the interval
// between two samples, and during a blink or a pause of the tracker the gaze stays where it was.
GazeSample gazeAt(const std::vector<GazeSample>& gaze, double time, double gap = kGazeGap);

// Reads a table of samples; samples/scenes/README.md describes the format. Throws Error(BadInput) with the file and
// the line of every mistake.
std::vector<GazeSample> readGazeCsv(const std::filesystem::path& file);

std::vector<Light> lightsAt(const Scene& scene, double time);

MotionKey poseAt(const Mover& mover, double time);

// World transforms of nodes at any time. A mover takes precedence over an animation that plays, and an animation over
// the transform of the node itself.
class NodePoses {
 public:
  explicit NodePoses(const Scene& scene);
  struct Pose {
    glm::mat4 toWorld{1};
    bool visible = true;
  };
  Pose at(uint32_t node, double time) const;
  const Mover* moverOf(uint32_t node) const;  // of the node or an ancestor; nullptr if none
  bool animated(uint32_t node) const;         // a channel moves it or an ancestor, or shapes its mesh
  bool moves(uint32_t node) const;            // a mover or a channel moves the node itself
  bool reshapes(uint32_t node) const;         // a channel sets the weights of its mesh's morph targets
  // Weights of the node's morph targets; morphTargets() values.
  std::vector<float> weightsAt(uint32_t node, double time) const;
  // Appends the world transforms of the joints of the node's skin times their inverse bind matrices.
  void jointsAt(uint32_t node, double time, std::vector<glm::mat4>& joints) const;
  // Times, in seconds from 0, at which to sample whatever acts on the node's vertices until all of it has run through
  // its keys: kSteps times between neighbouring keys, fewer if that would exceed kMostSamples times in all.
  std::vector<double> sampleTimes(uint32_t node) const;

 private:
  struct Channel {
    const Animation* animation;
    const AnimationChannel* channel;
  };
  glm::mat4 localAt(uint32_t node, double time, bool& visible) const;
  template <class Visit>  // visits the node and its ancestors, its joints and theirs
  void eachAbove(uint32_t node, const Visit& visit) const;

  const Scene& scene_;
  std::vector<uint32_t> moverOfNode_;           // empty if there are no movers
  std::vector<std::vector<Channel>> channels_;  // of each node; empty if nothing plays
};

// Poses of all objects of `geometry` at `time` and at `before`, named as the members of Frame.
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
// Bounds of the box `mesh` over all places to which `mover` brings its node, whether it is visible there or not.
Bounds sweptBounds(const NodePoses& poses, uint32_t node, const Mover& mover, const Bounds& mesh);

// Bounds of all places to which animations bring the vertices of an object. They are sampled at
// NodePoses::sampleTimes() and widened by a quarter of the amount by which the box grows or shrinks
// between two samples.
Bounds animatedBounds(const Scene& scene, const NodePoses& poses, const Object& object);

}  // namespace fovea::scene
