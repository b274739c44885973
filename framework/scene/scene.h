// Queries of a scene on the CPU: its hash, transforms, triangles and materials.
#pragma once

#include "fovea/scene.h"

namespace fovea::scene {

// Hash of everything on which a picture depends; names do not count. Loaders store it in Scene::hash.
uint64_t contentHash(const Scene& scene);

glm::mat4 localTransform(const Node& node);
std::vector<glm::mat4> worldTransforms(const Scene& scene);
// Object 0 is all static geometry; every dynamic node with a mesh is one more object, placed as at time 0. The bounds
// enclose the whole paths of movers and whole animations, so that they are the same in every frame
// (framework/scene/motion/motion.h says how finely these are sampled). Throws Error(BadInput) if there are more than
// 65535 materials or objects.
Geometry flatten(const Scene& scene);

// Look-up at LOD 0, bilinear or of the nearest texel, exactly as in shaders/scene/scene.glsl; linear RGBA. `uv` is given
// before the transform of `use`.
glm::vec4 sampleTexture(const Scene& scene, const TextureUse& use, glm::vec2 uv);
// Diffuse reflectance and alpha of a material at uv.
glm::vec4 reflectance(const Scene& scene, const Material& material, glm::vec2 uv);
glm::vec3 emission(const Scene& scene, const Material& material, glm::vec2 uv);
// The share of a surface that is seen at uv: 0 in the holes of alpha masks, alpha of BLEND with full materials, else 1.
// alpha: of the vertex colours.
float coverage(const Scene& scene, const Material& material, glm::vec2 uv, float alpha, bool fullMaterials);

// Whether a part of the light goes straight through, with full materials. Holes of alpha masks are no part of this.
inline bool letsLightThrough(const Material& m) { return m.blended || m.transmission > 0; }

// Numbers about a scene on which the sizes of a graph's resources may depend: "scene.triangles",
// "scene.static_triangles", "scene.vertices", "scene.lights", "scene.shadow_layers" and "scene.shadow_texels"
// (mostShadowTexels), each at least 1.
std::vector<std::pair<std::string, int64_t>> quantities(const Scene& scene, const Geometry& geometry);

}  // namespace fovea::scene
