#include "framework/scene/device/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/animator.h"
#include "framework/scene/device/environment_image.h"
#include "framework/scene/device/full_materials.h"
#include "framework/scene/device/gpu_textures.h"
#include "framework/scene/device/rays/emitter_tables.h"
#include "framework/scene/device/rays/ray_tables.h"
#include "framework/scene/lights.h"
#include "framework/scene/materials/bounced.h"
#include "shaders/common/records/shadow.h"

namespace fovea::scene {

namespace {

struct LightBlock {
  LightRecord lights[kMaxLights];
};

static_assert(uint32_t(LightType::Directional) == kLightDirectional &&
              uint32_t(LightType::Point) == kLightPoint && uint32_t(LightType::Spot) == kLightSpot);

uint32_t wrapCode(Wrap wrap) {
  return wrap == Wrap::Clamp ? kWrapClamp : wrap == Wrap::Mirror ? kWrapMirror : 0;
}

// Meyer et al. 2010; octEncode in scene.glsl.
glm::vec2 octEncode(glm::vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (n.z >= 0) return {n.x, n.y};
  return {(1 - std::abs(n.y)) * (n.x >= 0 ? 1.0f : -1.0f), (1 - std::abs(n.x)) * (n.y >= 0 ? 1.0f : -1.0f)};
}

constexpr VkBufferUsageFlags kTexelUsage =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

// A buffer with at least one (zero) element, because Vulkan has no empty buffers.
template <class T>
gpu::Buffer makeBuffer(gpu::Device& device, const char* name, std::vector<T> data, VkBufferUsageFlags usage) {
  if (data.empty()) data.emplace_back();
  gpu::Buffer buffer(device, {name, data.size() * sizeof(T), usage, gpu::MemoryKind::Device});
  gpu::upload(device, buffer, std::as_bytes(std::span(data)));
  return buffer;
}

std::vector<uint32_t> indexList(const Geometry& g) {
  std::vector<uint32_t> list;
  list.reserve(g.triangles.size() * 3);
  for (const Triangle& t : g.triangles) list.insert(list.end(), t.v, t.v + 3);
  return list;
}

std::vector<Triangle> triangleList(const Geometry& g) {
  std::vector<Triangle> list = g.triangles;
  list.insert(list.end(), g.lightTriangles.begin(), g.lightTriangles.end());
  return list;
}

std::vector<glm::vec4> positionList(const Geometry& g) {
  std::vector<glm::vec4> list;
  list.reserve(g.positions.size());
  for (const glm::vec3& p : g.positions) list.emplace_back(p, 1);
  return list;
}

std::vector<glm::vec4> attributeList(const Geometry& g) {
  std::vector<glm::vec4> list;
  list.reserve(g.positions.size());
  for (size_t i = 0; i < g.positions.size(); ++i) list.emplace_back(octEncode(g.normals[i]), g.uvs[i]);
  return list;
}

void checkCount(const char* what, size_t count, size_t limit) {
  if (count <= limit) return;
  throw Error(ExitCode::BadInput,
              "the scene has " + std::to_string(count) + " " + what + "; at most " + std::to_string(limit) +
                  " are supported",
              std::string("remove some ") + what);
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

TransformRows rowsOf(const glm::mat4& m) {
  const glm::mat4 rows = glm::transpose(m);
  return {rows[0], rows[1], rows[2]};
}

ObjectRecord objectEntry(const ObjectTransform& o) {
  ObjectRecord record;
  record.toWorld = rowsOf(o.toWorld);
  record.previousToWorld = rowsOf(o.previousToWorld);
  record.toObject = rowsOf(o.toObject);
  record.visible = float(o.visible);
  record.wasVisible = float(o.previousVisible);
  record.deforms = float(o.deforms);
  return record;
}

LightRecord lightEntry(const Light& light, uint32_t firstShadowLayer) {
  const SpotCone cone = spotCone(light);
  LightRecord record;
  record.position = light.position;
  record.type = uint32_t(light.type);
  record.direction = light.direction;
  record.range = light.range;
  record.intensity = light.color * light.intensity;
  record.firstShadowLayer = firstShadowLayer;
  record.cosInner = cone.cosInner;
  record.cosOuter = cone.cosOuter;
  record.coneScale = cone.scale();
  return record;
}

ViewBlock viewEntry(const View& v) {
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
  return block;
}

uint64_t alignUp(uint64_t value, uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

struct GpuScene::Impl {
  gpu::Device& device;
  uint32_t triangleCount, staticTriangles, vertexCount;
  glm::vec3 boundsMin{0}, boundsMax{0}, environment;
  float environmentTurn;
  uint32_t staticVertices, firstMovingLight;
  bool fullMaterials, rays;
  FullMaterials full;
  gpu::Buffer indices, triangles, positions, attributes, previous, materials, uniforms;
  uint32_t objectCount;
  std::vector<gpu::Buffer> objects;    // one per slot
  std::unique_ptr<Animator> animator;  // null if nothing moves
  RayTables rayTables;
  EmitterTables emitterTables;
  GpuTextures textures;
  gpu::Image environmentMap;
  uint64_t lightOffset = 0, viewOffset = 0, viewStride = 0, slotStride = 0;  // bytes within `uniforms`
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets;
  std::vector<DrawRun> runs;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& g, bool fullMaterials_, bool rays_)
      : device(d),
        triangleCount(uint32_t(g.triangles.size())),
        staticTriangles(g.staticTriangles),
        vertexCount(uint32_t(g.positions.size())),
        environment(scene.environment),
        environmentTurn(scene.environmentMap ? scene.environmentMap->turn() : 0),
        staticVertices(g.staticVertices()),
        firstMovingLight(g.light().firstMoving),
        fullMaterials(fullMaterials_),
        rays(rays_),
        objectCount(std::max(1u, uint32_t(g.objects.size()))),
        rayTables(d, scene, g, rays_),
        emitterTables(d, scene, g, fullMaterials_, rays_),
        textures(d, scene, fullMaterials_),
        environmentMap(environmentImage(d, scene.environmentMap.get())),
        runs(fovea::scene::drawRuns(scene, g, fullMaterials_)) {
    checkLights(scene.lights);
    if (!g.empty()) boundsMin = g.boundsMin, boundsMax = g.boundsMax;
    indices = makeBuffer(device, "scene indices", indexList(g),
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    static_assert(sizeof(Triangle) == 16);
    triangles = makeBuffer(device, "scene triangles", triangleList(g), kTexelUsage);
    positions = makeBuffer(device, "scene positions", positionList(g),
                           kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    previous = gpu::Buffer(device,
                           {"last positions of what moves", std::max(1u, movedVertices()) * sizeof(glm::vec4),
                            kTexelUsage | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                            gpu::MemoryKind::Device});
    attributes = makeBuffer(device, "scene attributes", attributeList(g), kTexelUsage);
    materials = makeBuffer(device, "scene materials", materialList(scene, g), kTexelUsage);
  }
  ~Impl() {
    vkDestroyDescriptorPool(device.handle(), pool, nullptr);
    vkDestroyDescriptorSetLayout(device.handle(), layout, nullptr);
  }

  TextureRecord textureEntry(const Scene& scene, const TextureUse& use) const;
  MaterialRecord materialEntry(const Scene& scene, const Material& m) const;
  std::vector<glm::vec4> materialList(const Scene& scene, const Geometry& g);
  void makeUniforms(uint32_t slots);
  void makeMoves(const Scene& scene, const Geometry& g, uint32_t slots);
  void storeObjects(const Frame& frame, uint32_t slot) const;
  uint32_t movedVertices() const { return vertexCount - staticVertices; }
  void makeLayout();
  void makeSets(uint32_t slots);
  void writeSet(uint32_t slot);
  template <class T>
  void store(uint32_t slot, uint64_t offset, const T& value) {
    std::memcpy(static_cast<std::byte*>(uniforms.mapped()) + slot * slotStride + offset, &value, sizeof(T));
  }
};

TextureRecord GpuScene::Impl::textureEntry(const Scene& scene, const TextureUse& use) const {
  const TexturePages::Place* place = textures.find(use.texture);
  if (!place) return {};
  const Texture& t = scene.textures[use.texture];
  const uint32_t flags = wrapCode(use.wrapU) | wrapCode(use.wrapV) << 2 | (t.srgb ? 0 : kTextureLinear) |
                         (use.set == 1 ? kTextureSecondSet : 0);
  const glm::mat3x2& m = use.transform;
  return {float(place->page),
          float(place->x),
          float(place->y),
          float(flags),
          {t.width, t.height},
          m[2],
          m[0],
          m[1]};
}

MaterialRecord GpuScene::Impl::materialEntry(const Scene& scene, const Material& m) const {
  MaterialRecord record;
  record.baseColor = bouncedColor(m, fullMaterials);
  record.alpha = m.baseColor.a;
  record.emission = fullMaterials && m.unlit ? glm::vec3(0) : m.emission;
  const bool transmits = fullMaterials && m.transmission > 0;
  record.alphaCutoff = m.masked ? m.alphaCutoff : transmits ? -1.0f : 0.0f;
  record.colorTexture = textureEntry(scene, m.baseColorTexture);
  record.emissionTexture = textureEntry(scene, m.emissionTexture);
  if (m.doubleSided) record.colorTexture.flags += float(kMaterialDoubleSided);
  if (fullMaterials && m.blended) record.colorTexture.flags += float(kMaterialBlended);
  if (transmits) record.colorTexture.flags += float(kMaterialTransmits);
  return record;
}

std::vector<glm::vec4> GpuScene::Impl::materialList(const Scene& scene, const Geometry& g) {
  static_assert(sizeof(MaterialRecord) % sizeof(glm::vec4) == 0);
  std::vector<glm::vec4> texels(scene.materials.size() * (sizeof(MaterialRecord) / sizeof(glm::vec4)));
  auto* records = reinterpret_cast<MaterialRecord*>(texels.data());
  for (size_t i = 0; i < scene.materials.size(); ++i) records[i] = materialEntry(scene, scene.materials[i]);
  if (fullMaterials)
    full = appendFullMaterials(
        scene, g, [&](const TextureUse& use) { return textureEntry(scene, use); }, texels);
  const uint64_t limit = device.limits().maxTexelBufferElements;
  if (texels.size() > limit && !device.lacks("maxTexelBufferElements"))
    throw Error(ExitCode::OutOfMemory,
                "scene materials: " + std::to_string(texels.size()) +
                    " elements exceed this device's maxTexelBufferElements " + std::to_string(limit),
                "use diffuse materials");
  return texels;
}

void GpuScene::Impl::makeUniforms(uint32_t slots) {
  const uint64_t alignment = std::max<uint64_t>(16, device.limits().minUniformBufferOffsetAlignment);
  lightOffset = alignUp(sizeof(FrameBlock), alignment);
  viewOffset = alignUp(lightOffset + sizeof(LightBlock), alignment);
  viewStride = alignUp(sizeof(ViewBlock), alignment);
  slotStride = viewOffset + kMaxViews * viewStride;
  uniforms = gpu::Buffer(device, {"scene uniforms", slots * slotStride, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                  gpu::MemoryKind::Upload});
  std::memset(uniforms.mapped(), 0, slots * slotStride);
}

void GpuScene::Impl::makeMoves(const Scene& scene, const Geometry& g, uint32_t slots) {
  if (movedVertices() > 0) animator = std::make_unique<Animator>(device, scene, g, slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    objects.emplace_back(device, gpu::BufferDesc{"scene objects", objectCount * sizeof(ObjectRecord),
                                                 kTexelUsage, gpu::MemoryKind::Upload});
    storeObjects({}, slot);
  }
}

// Objects for which the frame has no pose stay where their vertices are.
void GpuScene::Impl::storeObjects(const Frame& frame, uint32_t slot) const {
  auto* entries = static_cast<ObjectRecord*>(objects[slot].mapped());
  for (uint32_t i = 0; i < objectCount; ++i)
    entries[i] = objectEntry(i < frame.objects.size() ? frame.objects[i] : ObjectTransform{});
}

constexpr VkDescriptorType kBindings[] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,          // 0 frame
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,  // 1 view
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,          // 2 lights
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 3 triangles
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 4 positions
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 5 attributes
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 6 materials
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,  // 7 textures
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 8 objects
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 9 last frame's positions
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,  // 10 environment map
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 11 nodes that rays traverse
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 12 triangles that rays hit
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 13 light sources that rays are aimed at
};
constexpr uint32_t kBindingCount = uint32_t(std::size(kBindings));
constexpr uint32_t kTexelBindings =
    uint32_t(std::ranges::count(kBindings, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER));

// Storage buffers take the place of texel buffers where these are too small (common/device/texels.glsl).
VkDescriptorType typeOf(uint32_t binding, const gpu::Device& device) {
  const bool texels = kBindings[binding] == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
  return texels && device.lacks("maxTexelBufferElements") ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                          : kBindings[binding];
}

void GpuScene::Impl::makeLayout() {
  VkDescriptorSetLayoutBinding bindings[kBindingCount]{};
  for (uint32_t i = 0; i < kBindingCount; ++i)
    bindings[i] = {i, typeOf(i, device), 1, VK_SHADER_STAGE_ALL, nullptr};
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = kBindingCount;
  info.pBindings = bindings;
  gpu::check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout),
             "the layout of the scene's set");
}

void GpuScene::Impl::makeSets(uint32_t slots) {
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * slots},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, slots},
                                        {typeOf(3, device), kTexelBindings * slots},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * slots}};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = slots;
  poolInfo.poolSizeCount = uint32_t(std::size(sizes));
  poolInfo.pPoolSizes = sizes;
  gpu::check(vkCreateDescriptorPool(device.handle(), &poolInfo, nullptr, &pool),
             "the descriptor pool of the scene");
  const std::vector<VkDescriptorSetLayout> layouts(slots, layout);
  sets.resize(slots);
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorPool = pool;
  info.descriptorSetCount = slots;
  info.pSetLayouts = layouts.data();
  gpu::check(vkAllocateDescriptorSets(device.handle(), &info, sets.data()),
             "the descriptor sets of the scene");
  for (uint32_t slot = 0; slot < slots; ++slot) writeSet(slot);
}

void GpuScene::Impl::writeSet(uint32_t slot) {
  const uint64_t base = slot * slotStride;
  const VkDescriptorBufferInfo blocks[3] = {{uniforms.handle(), base, sizeof(FrameBlock)},
                                            {uniforms.handle(), base + viewOffset, sizeof(ViewBlock)},
                                            {uniforms.handle(), base + lightOffset, sizeof(LightBlock)}};
  struct Texels {
    uint32_t binding;
    gpu::Buffer* buffer;
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  };
  constexpr VkFormat kWords = VK_FORMAT_R32G32B32A32_UINT;
  const Texels texels[kTexelBindings] = {{3, &triangles, kWords},
                                         {4, &positions},
                                         {5, &attributes},
                                         {6, &materials},
                                         {8, &objects[slot]},
                                         {9, &previous},
                                         {11, &rayTables.nodes(), kWords},
                                         {12, &rayTables.triangles(), kWords},
                                         {13, &emitterTables.texels(), kWords}};
  VkBufferView views[kTexelBindings] = {};
  VkDescriptorBufferInfo wholes[kTexelBindings];
  const VkSampler nearest = gpu::sampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  const VkDescriptorImageInfo image{nearest, textures.image().view(),
                                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
      environmentInfo{nearest, environmentMap.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet writes[kBindingCount]{};
  for (uint32_t i = 0; i < kBindingCount; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = sets[slot];
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = typeOf(i, device);
  }
  for (uint32_t i = 0; i < 3; ++i) writes[i].pBufferInfo = &blocks[i];
  for (uint32_t i = 0; i < kTexelBindings; ++i) {
    const Texels& t = texels[i];
    wholes[i] = {t.buffer->handle(), 0, VK_WHOLE_SIZE};
    writes[t.binding].pBufferInfo = &wholes[i];
    if (writes[t.binding].descriptorType != VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) continue;
    views[i] = t.buffer->texelView(t.format);
    writes[t.binding].pTexelBufferView = &views[i];
  }
  writes[7].pImageInfo = &image;
  writes[10].pImageInfo = &environmentInfo;
  vkUpdateDescriptorSets(device.handle(), kBindingCount, writes, 0, nullptr);
}

GpuScene::GpuScene(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t framesInFlight,
                   bool fullMaterials, bool rays)
    : impl_(std::make_unique<Impl>(device, scene, geometry, fullMaterials, rays)) {
  const uint32_t slots = std::max(1u, framesInFlight);
  impl_->makeUniforms(slots);
  impl_->makeMoves(scene, geometry, slots);
  impl_->makeLayout();
  impl_->makeSets(slots);
}

GpuScene::~GpuScene() = default;

void GpuScene::update(const Frame& frame, uint32_t slot) {
  checkLights(frame.lights);
  checkCount("views", frame.views.size(), kMaxViews);
  if (slot >= impl_->sets.size())
    throw Error(ExitCode::Internal, "no slot " + std::to_string(slot) + " of the scene");
  Impl& s = *impl_;
  FrameBlock block;
  block.index = uint32_t(frame.index);
  block.seed = frame.seed;
  block.lightCount = uint32_t(frame.lights.size());
  block.triangleCount = s.triangleCount;
  block.staticTriangleCount = s.staticTriangles;
  block.vertexCount = s.vertexCount;
  block.time = float(frame.time);
  block.exposure = frame.exposure;
  block.boundsMin = s.boundsMin;
  block.boundsMax = s.boundsMax;
  block.environment = s.environment;
  block.environmentTurn = s.environmentTurn;
  block.firstMovingVertex = s.staticVertices;
  block.firstMovingTriangle = s.firstMovingLight;
  block.firstSurface = s.full.firstSurface;
  block.firstAlbedo = s.full.firstAlbedo;
  block.firstTangent = s.full.firstTangent;
  block.firstDetail = s.full.firstDetail;
  impl_->store(slot, 0, block);
  uint32_t layer = 0;
  for (size_t i = 0; i < frame.lights.size(); ++i) {
    impl_->store(slot, s.lightOffset + i * sizeof(LightRecord), lightEntry(frame.lights[i], layer));
    layer += shadowLayers(frame.lights[i]);
  }
  for (size_t i = 0; i < frame.views.size(); ++i)
    impl_->store(slot, s.viewOffset + i * s.viewStride, viewEntry(frame.views[i]));
  s.storeObjects(frame, slot);
  if (s.animator) s.animator->update(frame, slot);
}

void GpuScene::recordMoves(VkCommandBuffer cmd, uint32_t slot) const {
  Impl& s = *impl_;
  if (!s.animator) return;
  s.animator->record(cmd, slot, s.positions, s.attributes, s.previous);
  s.rayTables.record(cmd, s.positions);
  s.emitterTables.record(cmd, s.positions, s.triangles);
}

bool GpuScene::moves() const { return impl_->animator != nullptr; }

VkDescriptorSetLayout GpuScene::setLayout() const { return impl_->layout; }
VkDescriptorSet GpuScene::set(uint32_t slot) const { return impl_->sets.at(slot); }
uint32_t GpuScene::viewOffset(uint32_t view) const { return uint32_t(view * impl_->viewStride); }
gpu::Buffer& GpuScene::indices() const { return impl_->indices; }
gpu::Buffer& GpuScene::triangles() const { return impl_->triangles; }
gpu::Buffer& GpuScene::positions() const { return impl_->positions; }
gpu::Buffer& GpuScene::attributes() const { return impl_->attributes; }
gpu::Buffer& GpuScene::previous() const { return impl_->previous; }
gpu::Buffer& GpuScene::materials() const { return impl_->materials; }
bool GpuScene::fullMaterials() const { return impl_->fullMaterials; }
bool GpuScene::rays() const { return impl_->rays; }
const std::vector<DrawRun>& GpuScene::drawRuns() const { return impl_->runs; }
uint32_t GpuScene::triangleCount() const { return impl_->triangleCount; }
uint32_t GpuScene::vertexCount() const { return impl_->vertexCount; }

}  // namespace fovea::scene
