#include "framework/scene/tables/blocks.h"

#include <string>

#include "fovea/error.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/lights.h"
#include "shaders/records/shadow.h"

namespace fovea::scene {
namespace {

static_assert(uint32_t(LightType::Directional) == kLightDirectional &&
              uint32_t(LightType::Point) == kLightPoint && uint32_t(LightType::Spot) == kLightSpot);

TransformRows rowsOf(const glm::mat4& m) {
  const glm::mat4 rows = glm::transpose(m);
  return {rows[0], rows[1], rows[2]};
}

LightRecord lightRecord(const Light& light, float preExposure, uint32_t firstShadowLayer) {
  const SpotCone cone = spotCone(light);
  LightRecord record;
  record.position = light.position;
  record.type = uint32_t(light.type);
  record.direction = light.direction;
  record.range = light.range;
  record.intensity = light.color * (light.intensity * preExposure);
  record.firstShadowLayer = firstShadowLayer;
  record.cosInner = cone.cosInner;
  record.cosOuter = cone.cosOuter;
  record.coneScale = cone.scale();
  return record;
}

void checkLights(std::span<const Light> lights) {
  checkCount("lights", lights.size(), kMaxLights);
  const uint32_t layers = shadowLayers(lights);
  if (layers <= kMaxShadowLayers) return;
  throw Error(ExitCode::BadInput,
              "the lights of the scene need " + std::to_string(layers) + " shadow maps; at most " +
                  std::to_string(kMaxShadowLayers) + " are supported",
              "replace point lights, which need six each, by spot lights, or remove some");
}

}  // namespace

void checkCount(const char* what, size_t count, size_t limit) {
  if (count <= limit) return;
  throw Error(ExitCode::BadInput,
              "the scene has " + std::to_string(count) + " " + what + "; at most " + std::to_string(limit) +
                  " are supported",
              std::string("remove some ") + what);
}

FrameBlock sceneBlock(const Scene& scene, const Geometry& geometry, const FullMaterials& full) {
  FrameBlock block;
  block.triangleCount = uint32_t(geometry.triangles.size());
  block.staticTriangleCount = geometry.staticTriangles;
  block.vertexCount = uint32_t(geometry.positions.size());
  if (!geometry.empty()) block.boundsMin = geometry.boundsMin, block.boundsMax = geometry.boundsMax;
  block.environment = scene.environment * preExposure(scene);
  block.environmentTurn = scene.environmentMap ? scene.environmentMap->turn() : 0;
  block.firstMovingVertex = geometry.staticVertices();
  block.firstMovingTriangle = geometry.light().firstMoving;
  block.firstSurface = full.firstSurface;
  block.firstAlbedo = full.firstAlbedo;
  block.firstTangent = full.firstTangent;
  block.firstDetail = full.firstDetail;
  block.transparent = full.transparent;
  return block;
}

FrameBlock frameBlock(FrameBlock block, const Frame& frame) {
  block.index = uint32_t(frame.index);
  block.seed = frame.seed;
  block.lightCount = uint32_t(frame.lights.size());
  block.time = float(frame.time);
  block.exposure = frame.storedExposure();
  block.preExposure = frame.preExposure;
  return block;
}

PixelRays pixelRays(const View& view) {
  const glm::mat4& projection = view.viewToClip;
  const glm::mat3 toWorld = glm::transpose(glm::mat3(view.worldToView));
  const glm::vec2 slope = 1.0f / glm::vec2(projection[0][0], projection[1][1]);
  const glm::vec2 pixel = 2.0f * slope / glm::max(glm::vec2(view.size), glm::vec2(1));
  PixelRays rays;
  rays.eye = view.eye;
  rays.corner = toWorld * glm::vec3((glm::vec2(projection[2]) - 1.0f) * slope, -1);
  rays.right = toWorld[0] * pixel.x;
  rays.down = toWorld[1] * pixel.y;
  return rays;
}

ViewBlock viewBlock(const View& v) {
  ViewBlock block;
  block.worldToView = v.worldToView;
  block.viewToClip = v.viewToClip;
  block.worldToClip = v.worldToClip;
  block.clipToWorld = v.clipToWorld;
  block.previousWorldToClip = v.previousWorldToClip;
  block.eye = v.eye;
  block.gaze = v.gaze;
  block.jitterStep = v.jitter - v.previousJitter;
  block.size = glm::max(glm::vec2(v.size), glm::vec2(1));
  block.inverseSize = 1.0f / block.size;
  block.rays = pixelRays(v);
  return block;
}

std::vector<LightRecord> lightRecords(std::span<const Light> lights, float preExposure) {
  checkLights(lights);
  std::vector<LightRecord> records;
  records.reserve(lights.size());
  uint32_t layer = 0;
  for (const Light& light : lights) {
    records.push_back(lightRecord(light, preExposure, layer));
    layer += shadowLayers(light);
  }
  return records;
}

ObjectRecord objectRecord(const ObjectTransform& o) {
  ObjectRecord record;
  record.toWorld = rowsOf(o.toWorld);
  record.previousToWorld = rowsOf(o.previousToWorld);
  record.toObject = rowsOf(o.toObject);
  record.visible = float(o.visible);
  record.wasVisible = float(o.previousVisible);
  record.deforms = float(o.deforms);
  return record;
}

}  // namespace fovea::scene
