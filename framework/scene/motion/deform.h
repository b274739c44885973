// Vertices of one object in one frame: morph targets, then joints, then the way into the world; what
// shaders/animate does on the device.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Whether morph targets or joints move the vertices of the node's mesh one by one.
bool deforms(const Scene& scene, const Node& node);
// Whether joints place it: the transform of its own node does not count then.
bool skinned(const Scene& scene, const Node& node);
// Of the mesh of a node; 0: it has none.
size_t morphTargets(const Mesh& mesh);
// Of a node's morph targets as long as nothing animates them: morphTargets() of them.
std::vector<float> restWeights(const Scene& scene, const Node& node);

struct ObjectPose {
  glm::mat4 toWorld{1};
  bool visible = true;  // else: all vertices in one point
  std::span<const glm::mat4> joints{};
  std::span<const float> weights{};
};
// Of one of Geometry::objects; the pose points into the frame.
ObjectPose poseOf(const Object& object, size_t index, const Frame& frame);

// Vertices of all primitives of a mesh, one after the other, in the world. `stencils`: of the mesh's cage,
// when the cage is what deforms; else null. Normals are unit.
void placeVertices(const Mesh& mesh, const Stencils* stencils, const ObjectPose& pose, glm::vec3* positions,
                   glm::vec3* normals);

// Bent so that its inside is out: by the transform, or by the joints.
bool mirrored(const ObjectPose& pose);

}  // namespace fovea::scene
