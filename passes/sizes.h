// Requirements on the sizes of images that are wired to a pass.
#pragma once

#include <string>

#include "fovea/declaration.h"

namespace fovea::passes {

// Requires that the image at an input has this size, which is that of `of`: "its view".
void requireSize(graph::PassDeclaration& d, const std::string& port, const graph::SizeExpr& width,
                 const graph::SizeExpr& height, const std::string& of, const std::string& remedy);
// The same with the size of another input, which differs if they come from passes that look through views of different
// sizes.
void requireSameSize(graph::PassDeclaration& d, const std::string& port, const std::string& other);
// Requires that an atlas of square maps side by side, if it is wired, has a map for each VPL.
void requireMaps(graph::PassDeclaration& d, const std::string& atlas, const std::string& vpls);

}  // namespace fovea::passes
