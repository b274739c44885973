#include "passes/materials.h"

#include <string>

namespace fovea::passes {

using namespace graph;

namespace {

constexpr const char* kMaterials = "view.materials";

}  // namespace

bool fullMaterials(const Parameters& parameters) { return parameters.text(kMaterials) == "full"; }

SizeExpr fullMaterials() { return parameter(kMaterials); }

void requireMaterials(PassDeclaration& d) {
  const std::string normal = "gbuffer.normal", specular = "gbuffer.specular";
  d.require(!fullMaterials() ||
                (same(widthOf(specular), widthOf(normal)) && same(heightOf(specular), heightOf(normal))),
            "materials are `full`, but those of the G-buffer are not",
            "wire the G-buffer that pass gbuffer makes");
}

}  // namespace fovea::passes
