#include "passes/materials.h"

#include "fovea/error.h"

namespace fovea::passes {

using namespace graph;

namespace {

constexpr const char* kMaterials = "view.materials";

}  // namespace

bool fullMaterials(const Parameters& parameters) { return parameters.text(kMaterials) == "full"; }

SizeExpr fullMaterials() { return parameter(kMaterials); }

void checkMaterials(const PassContext& ctx) {
  const VkExtent3D specular = ctx.extent("gbuffer.specular"), normal = ctx.extent("gbuffer.normal");
  if (!fullMaterials(ctx.parameters()) ||
      (specular.width == normal.width && specular.height == normal.height))
    return;
  throw Error(ExitCode::BadInput, "materials are `full`, but those of the G-buffer are not",
              "wire the G-buffer that pass gbuffer makes");
}

}  // namespace fovea::passes
