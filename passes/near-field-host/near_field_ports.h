// What passes near-field-host and near-field-device have in common: ports, parameters and counters.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// read, write: how the pass uses its input and its outputs.
void declareNearField(graph::PassDeclaration& d, graph::Usage read, graph::Usage write);
// Radius of the fovea in image widths for these parameters: with a `spacing` of 2, all of the picture is like the fovea.
float nearFieldFovea(const scene::View& view, const graph::Parameters& parameters);
// Throws Error(BadInput) if the blocks of pixels have no possible width, or if the G-buffer lacks full materials.
void checkNearField(const graph::PassContext& ctx, const std::string& pass);
// Throws Error(BadInput) if the G-buffer is not of this size, that of the view through which the pass looks.
void checkGBufferSize(const graph::PassContext& ctx, const std::string& pass, glm::uvec2 view);

}  // namespace fovea::passes
