// Materials as light finds them where nobody asks in which direction it leaves (rays/reflection.h does). All are taken
// for diffuse, also where the picture shows full materials; metals then keep their colour, as the mean of what they
// reflect differs little from that, and otherwise they are black.
#pragma once

#include "framework/scene/scene.h"

namespace fovea::scene {

// The factor on the base colour's texture.
glm::vec3 bouncedColor(const Material& material, bool fullMaterials);
// With diffuse materials the same as reflectance() without alpha.
glm::vec3 bouncedReflectance(const Scene& scene, const Material& material, glm::vec2 uv, bool fullMaterials);

}  // namespace fovea::scene
