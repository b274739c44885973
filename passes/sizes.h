// Checks of the sizes of images that are wired to a pass.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// Throws Error(BadInput) unless the image at a port of the pass is of this size, which is that of `of`: "its view".
void checkSize(const graph::PassContext& ctx, const std::string& port, glm::uvec2 size, const std::string& of,
               const std::string& remedy);
// The same with the size of another port, which differs if they come from passes that look through views of
// different sizes.
void checkSameSize(const graph::PassContext& ctx, const std::string& port, const std::string& other);

}  // namespace fovea::passes
