#include "passes/sizes.h"

#include "fovea/error.h"

namespace fovea::passes {
namespace {

std::string text(uint32_t width, uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

void checkSize(const graph::PassContext& ctx, const std::string& port, glm::uvec2 size, const std::string& of,
               const std::string& remedy) {
  const VkExtent3D its = ctx.extent(port);
  if (size == glm::uvec2(its.width, its.height)) return;
  throw Error(
      ExitCode::BadInput,
      "`" + port + "` has " + text(its.width, its.height) + " pixels, " + of + " has " + text(size.x, size.y),
      remedy);
}

void checkSameSize(const graph::PassContext& ctx, const std::string& port, const std::string& other) {
  const VkExtent3D size = ctx.extent(other);
  checkSize(ctx, port, {size.width, size.height}, "`" + other + "`", "wire both to passes of one view");
}

}  // namespace fovea::passes
