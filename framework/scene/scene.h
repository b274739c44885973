// What can be asked of a scene on the CPU: its hash, its transforms, its triangles, its materials.
#pragma once

#include "fovea/scene.h"

namespace fovea::scene {

// Of everything that a picture depends on (names do not count); loaders store it in Scene::hash.
uint64_t contentHash(const Scene& scene);

glm::mat4 localTransform(const Node& node);
std::vector<glm::mat4> worldTransforms(const Scene& scene);
// Object 0 is all static geometry; every dynamic node with a mesh is one more object, placed as at time 0.
// The bounds hold the whole paths of movers and the whole of animations (framework/scene/motion/motion.h says how
// finely they are looked at), so that they are the same in every frame. Throws Error(BadInput) past 65535
// materials or objects.
Geometry flatten(const Scene& scene);

// Bilinear LOD-0 look-up exactly as shaders/common/scene.glsl does it; linear RGBA. uv before the transform.
glm::vec4 sampleTexture(const Scene& scene, const TextureUse& use, glm::vec2 uv);
// Diffuse reflectance and alpha of a material at uv.
glm::vec4 reflectance(const Scene& scene, const Material& material, glm::vec2 uv);
glm::vec3 emission(const Scene& scene, const Material& material, glm::vec2 uv);

// Numbers about a scene that sizes of a graph's resources may depend on: "scene.triangles", "scene.static_triangles",
// "scene.vertices", "scene.lights" and "scene.shadow_layers", each at least 1.
std::vector<std::pair<std::string, int64_t>> quantities(const Scene& scene, const Geometry& geometry);

}  // namespace fovea::scene
