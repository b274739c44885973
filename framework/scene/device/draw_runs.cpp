#include "framework/scene/device/draw_runs.h"

namespace fovea::scene {
namespace {

DrawKind kindOf(const Material& m, bool fullMaterials) {
  if (fullMaterials && letsLightThrough(m)) return DrawKind::Transparent;
  if (m.masked) return DrawKind::Masked;
  return m.doubleSided ? DrawKind::DoubleSided : DrawKind::SingleSided;
}

}  // namespace

std::vector<DrawRun> drawRuns(const Scene& scene, const Geometry& geometry, bool fullMaterials) {
  std::vector<DrawRun> runs;
  const uint32_t count = uint32_t(geometry.triangles.size());
  for (uint32_t i = 0; i < count; ++i) {
    const DrawKind kind = kindOf(scene.materials[geometry.triangles[i].material()], fullMaterials);
    if (runs.empty() || runs.back().kind != kind) {
      if (runs.size() == kMaxDrawRuns)
        return {{fullMaterials ? DrawKind::Transparent : DrawKind::Masked, 0, count}};
      runs.push_back({kind, i, 0});
    }
    ++runs.back().triangleCount;
  }
  return runs;
}

}  // namespace fovea::scene
