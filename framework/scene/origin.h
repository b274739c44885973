// Where a scene lies in its author's coordinates. Single precision resolves 0.5 m at 5000 km, so that a scene with map
// coordinates, such as UTM, cannot be shown with them. Loaders therefore move the origin of such a scene into its
// middle, in double precision: Scene::origin is the point of the author's world that becomes 0, and everything else in
// the scene is relative to it. What a file or an option says in the author's coordinates is converted once, here.
//
// The rule: along each axis, the origin moves if the middle of the scene lies farther from 0 than 16 times its radius.
// All other scenes keep the origin 0, and their numbers are untouched. Likewise, inside a scene,
//   a mesh whose vertices lie that far from 0 in its own space gets an origin in their middle, and
//   a node that only carries others, and that lies that far from the scene, is brought back to it,
// so that large translations that cancel each other along a branch of the tree leave no error.
//
// Some files have a forgotten object at 0 and everything else at map coordinates. Parts whose distance from the rest is
// more than a thousand times the size of what most parts occupy do not count.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct DoubleBounds {
  glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
  void include(glm::dvec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
  void include(const DoubleBounds& box, const glm::dmat4& transform);
  bool empty() const { return !(low.x <= high.x); }
};

// Bounds of the parts of a scene that count for its origin, and the origin of a scene with such bounds.
DoubleBounds boundsOfMost(const std::vector<DoubleBounds>& parts);
glm::dvec3 originOf(const DoubleBounds& authored);

// Bounds of each node's mesh at rest, in the author's coordinates.
std::vector<DoubleBounds> authoredParts(const Scene& scene);

// Applies the rule to a scene whose origins are all 0. `authored` holds the local transforms of its nodes in double
// precision, of which those in the scene are roundings.
void recentre(Scene& scene, const std::vector<glm::dmat4>& authored);

// Positions in the world.
inline glm::vec3 fromAuthor(const Scene& scene, glm::dvec3 position) {
  return glm::vec3(position - scene.origin);
}
inline glm::dvec3 toAuthor(const Scene& scene, glm::vec3 position) {
  return scene.origin + glm::dvec3(position);
}

// The translation that a node without a matrix has, in the author's space of its parent; and the translation in the
// scene that corresponds to one of the author's together with this rotation.
glm::dvec3 authoredTranslation(const Scene& scene, uint32_t node);
glm::vec3 translationFrom(const Scene& scene, uint32_t node, glm::dvec3 authored, const glm::quat& rotation);

}  // namespace fovea::scene
