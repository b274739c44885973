#include "passes/near-field-host/cached_light.h"

#include "framework/base/random.h"

namespace fovea::passes {

using namespace scene;

glm::vec3 gatheredLight(const SurfaceTracer& surfaces, const TracedSurface& v, uint32_t bounces,
                        uint32_t stream, const GatherCache* cache, float cellWidth, GatheredLight& sum) {
  uint64_t cell = 0;
  std::optional<glm::vec3> known;
  if (cache) {
    const auto number = [&](uint32_t i) { return uniformFloat(randomStream(stream, i, kCellStream, 0)); };
    cell = cache->cellOf(v.position, v.face, glm::vec3(number(0), number(1), number(2)) - 0.5f, cellWidth);
    known = cache->find(cell);
    if (known && number(3) >= kGatheredAnew) return *known;
  }
  ++sum.gathered;
  const glm::vec3 light = surfaces.gather(v, bounces, 1, stream, sum.rays);
  if (cache) sum.samples.push_back({cell, light});
  return known.value_or(light);
}

}  // namespace fovea::passes
