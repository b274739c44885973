// The parameter `materials` of passes that support full materials.
#pragma once

#include <cstdint>
#include <string>

#include "fovea/pass.h"

namespace fovea::scene {
enum class Passing : uint8_t;  // framework/scene/rays/ray_scene.h
}

namespace fovea::passes {

// what: what the pass does with full materials.
void declareMaterials(graph::PassDeclaration& d, const std::string& what);
bool fullMaterials(const graph::Parameters& parameters);
// How rays on the host hit surfaces.
scene::Passing passingOf(const graph::Parameters& parameters);
// 0 or 1.
graph::SizeExpr fullMaterials();
// Throws Error(BadInput) if the pass asks for full materials, but the one that made its input `gbuffer` did not.
void checkMaterials(const graph::PassContext& ctx);

}  // namespace fovea::passes
