// Places the vertices of one object in one frame: morph targets first, then joints, then the transform to world
// space. shaders/animate does the same on the device.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Whether morph targets or joints move the vertices of the node's mesh individually.
bool deforms(const Scene& scene, const Node& node);
// Whether joints place the node's mesh; the transform of the node is ignored then.
bool skinned(const Scene& scene, const Node& node);
// Number of morph targets; 0 if none.
size_t morphTargets(const Mesh& mesh);
// Weights of a node's morph targets while nothing animates them; morphTargets() values.
std::vector<float> restWeights(const Scene& scene, const Node& node);

struct ObjectPose {
  glm::mat4 toWorld{1};
  bool visible = true;  // if false, all vertices collapse to one point
  std::span<const glm::mat4> joints{};
  std::span<const float> weights{};
};
// Pose of the object with this index in Geometry::objects. The spans of the pose point into the frame.
ObjectPose poseOf(const Object& object, size_t index, const Frame& frame);

// Places the vertices of all primitives of a mesh, one after the other, in world space. `stencils` are those of the
// mesh's cage if the cage is what deforms, otherwise null. Normals are unit.
void placeVertices(const Mesh& mesh, const Stencils* stencils, const ObjectPose& pose, glm::vec3* positions,
                   glm::vec3* normals);

// Whether the transform or the joints turn the object inside out (negative determinant).
bool mirrored(const ObjectPose& pose);

}  // namespace fovea::scene
