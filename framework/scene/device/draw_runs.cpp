#include "framework/scene/device/draw_runs.h"

namespace fovea::scene {

std::vector<DrawRun> drawRuns(const Scene& scene, const Geometry& geometry, bool fullMaterials) {
  std::vector<DrawRun> runs;
  const uint32_t count = uint32_t(geometry.triangles.size());
  for (uint32_t i = 0; i < count; ++i) {
    const Material& material = scene.materials[geometry.triangles[i].material()];
    const bool tested = material.masked || (fullMaterials && material.transmission > 0);
    const DrawKind kind = tested                 ? DrawKind::Tested
                          : material.doubleSided ? DrawKind::DoubleSided
                                                 : DrawKind::SingleSided;
    if (runs.empty() || runs.back().kind != kind) {
      if (runs.size() == kMaxDrawRuns) return {{DrawKind::Tested, 0, count}};
      runs.push_back({kind, i, 0});
    }
    ++runs.back().triangleCount;
  }
  return runs;
}

}  // namespace fovea::scene
