#include "framework/scene/host/host_scene.h"

#include <algorithm>
#include <optional>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/tables/blocks.h"
#include "framework/scene/tables/emitter_table.h"
#include "framework/scene/texture_taps.h"

namespace fovea::scene {
namespace {

// Textures are read where the scene has them, each as a page of its own.
MaterialTable tableOf(const Scene& scene, const Geometry& geometry, bool fullMaterials) {
  return materialTable(scene, geometry, fullMaterials, [&](uint32_t texture) -> std::optional<glm::uvec3> {
    const bool there = texture < scene.textures.size() && !scene.textures[texture].rgba.empty();
    return there ? std::optional(glm::uvec3(0, 0, texture)) : std::nullopt;
  });
}

bool anyEmitterMoves(const Geometry& geometry) {
  return std::ranges::any_of(geometry.emissive,
                             [&](uint32_t triangle) { return triangle >= geometry.staticTriangles; });
}

}  // namespace

HostScene::HostScene(const Scene& scene, const Geometry& geometry, bool fullMaterials)
    : scene_(scene),
      geometry_(&geometry),
      fullMaterials_(fullMaterials),
      emittersMove_(anyEmitterMoves(geometry)),
      materials_(tableOf(scene, geometry, fullMaterials)),
      emitters_(emitterTable(scene, geometry, fullMaterials)),
      still_(sceneBlock(scene, geometry, materials_.full)) {}

void HostScene::update(const Frame& frame) {
  geometry_ = frame.geometry;
  frame_ = frameBlock(still_, frame);
  lights_ = lightRecords(frame.lights, frame.preExposure);
  views_.clear();
  for (const View& view : frame.views) views_.push_back(viewBlock(view));
  if (emittersMove_) emitters_ = emitterTable(scene_, *geometry_, fullMaterials_);
  rays_ = {};
}

const RayScene& HostScene::rays(Passing passing) const {
  std::shared_ptr<const RayScene>& rays = rays_[static_cast<size_t>(passing)];
  if (!rays) rays = RayScene::cached(scene_, *geometry_, passing);
  return *rays;
}

glm::vec4 HostScene::texel(glm::ivec3 p, bool linear) const {
  const Texture& t = scene_.textures[size_t(p.z)];
  const uint8_t* texel = &t.rgba[(size_t(p.y) * t.width + size_t(p.x)) * 4];
  constexpr float kCode = 1.0f / 255.0f;
  const float alpha = float(texel[3]) * kCode;
  if (linear) return {float(texel[0]) * kCode, float(texel[1]) * kCode, float(texel[2]) * kCode, alpha};
  const std::array<float, 256>& decoded = srgbTable();
  return {decoded[texel[0]], decoded[texel[1]], decoded[texel[2]], alpha};
}

glm::ivec2 HostScene::environmentSize() const {
  const EnvironmentMap* map = scene_.environmentMap.get();
  return map ? glm::ivec2(map->width(), map->height()) : glm::ivec2(1);
}

glm::vec3 HostScene::environmentTexel(glm::ivec2 p) const {
  const EnvironmentMap& map = *scene_.environmentMap;
  return map.texels()[size_t(p.y) * map.width() + size_t(p.x)] * frame_.preExposure;
}

}  // namespace fovea::scene
