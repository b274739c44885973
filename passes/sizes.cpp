#include "passes/sizes.h"

namespace fovea::passes {

using namespace graph;

void requireSize(PassDeclaration& d, const std::string& port, const SizeExpr& width, const SizeExpr& height,
                 const std::string& of, const std::string& remedy) {
  d.require(same(widthOf(port), width) && same(heightOf(port), height),
            "`" + port + "` is not of the size of " + of, remedy);
}

void requireSameSize(PassDeclaration& d, const std::string& port, const std::string& other) {
  requireSize(d, port, widthOf(other), heightOf(other), "`" + other + "`", "wire both to passes of one view");
}

void requireMaps(PassDeclaration& d, const std::string& atlas, const std::string& vpls) {
  d.require(atMost(countOf(vpls), ceilDiv(widthOf(atlas), heightOf(atlas)) * layersOf(atlas)),
            "`" + atlas + "` holds fewer maps than there are VPLs",
            "wire the same VPLs to the atlas and to this pass");
}

}  // namespace fovea::passes
