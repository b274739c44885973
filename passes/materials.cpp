#include "passes/materials.h"

#include "fovea/error.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

using namespace graph;

void declareMaterials(PassDeclaration& d, const std::string& what) {
  d.parameter("materials", choice("diffuse", {"diffuse", "full"}),
              "materials of surfaces: `diffuse` treats all as Lambertian and metals as black; " + what);
}

bool fullMaterials(const Parameters& parameters) { return parameters.text("materials") == "full"; }

scene::Passing passingOf(const Parameters& parameters) {
  return fullMaterials(parameters) ? scene::Passing::Met : scene::Passing::Never;
}

SizeExpr fullMaterials() { return parameter("materials"); }

void checkMaterials(const PassContext& ctx) {
  const VkExtent3D specular = ctx.extent("gbuffer.specular"), normal = ctx.extent("gbuffer.normal");
  if (!fullMaterials(ctx.parameters()) ||
      (specular.width == normal.width && specular.height == normal.height))
    return;
  throw Error(ExitCode::BadInput, "materials are `full`, but those of the G-buffer are not",
              "give both passes the same `materials`");
}

}  // namespace fovea::passes
