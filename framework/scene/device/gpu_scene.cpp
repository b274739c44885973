#include "framework/scene/device/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/rays/acceleration_structure.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/animator.h"
#include "framework/scene/device/environment_image.h"
#include "framework/scene/device/gpu_textures.h"
#include "framework/scene/device/rays/emitter_tables.h"
#include "framework/scene/device/rays/ray_tables.h"
#include "framework/scene/host/host_scene.h"
#include "framework/scene/lights.h"
#include "framework/scene/tables/blocks.h"
#include "framework/scene/tables/material_table.h"

namespace fovea::scene {

namespace {

struct LightBlock {
  LightRecord lights[kMaxLights];
};

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

// How positions must be usable for rays.
VkBufferUsageFlags rayInput(const gpu::Device& device) {
  return device.lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME) ? 0 : gpu::kBuildInputUsage;
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
  for (size_t i = 0; i < g.positions.size(); ++i)
    list.emplace_back(g.positions[i], g.colors.empty() ? 1.0f : g.colors[i].a);
  return list;
}

std::vector<glm::vec4> attributeList(const Geometry& g) {
  std::vector<glm::vec4> list;
  list.reserve(g.positions.size());
  for (size_t i = 0; i < g.positions.size(); ++i) list.emplace_back(octEncode(g.normals[i]), g.uvs[i]);
  return list;
}

uint64_t alignUp(uint64_t value, uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

}  // namespace

struct GpuScene::Impl {
  gpu::Device& device;
  uint32_t triangleCount, vertexCount, staticVertices;
  bool fullMaterials;
  RaysWanted rays;
  FullMaterials full;
  FrameBlock block;  // what is the same in every frame
  gpu::Buffer indices, triangles, positions, attributes, previous, materials, uniforms;
  uint32_t objectCount;
  std::vector<gpu::Buffer> objects;    // one per slot
  std::unique_ptr<Animator> animator;  // null if nothing moves
  std::unique_ptr<RayTables> rayTables;
  EmitterTables emitterTables;
  GpuTextures textures;
  gpu::Image environmentMap;
  uint64_t lightOffset = 0, viewOffset = 0, viewStride = 0, slotStride = 0;  // bytes within `uniforms`
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets;
  std::vector<DrawRun> runs;
  std::optional<HostScene> host;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& g, bool fullMaterials_, RaysWanted rays_)
      : device(d),
        triangleCount(uint32_t(g.triangles.size())),
        vertexCount(uint32_t(g.positions.size())),
        staticVertices(g.staticVertices()),
        fullMaterials(fullMaterials_),
        rays(rays_),
        objectCount(std::max(1u, uint32_t(g.objects.size()))),
        emitterTables(d, scene, g, fullMaterials_, rays_.device),
        textures(d, scene, fullMaterials_),
        environmentMap(environmentImage(d, scene.environmentMap.get(), preExposure(scene))),
        runs(fovea::scene::drawRuns(scene, g, fullMaterials_)) {
    lightRecords(scene.lights, preExposure(scene));  // throws if there are too many
    indices = makeBuffer(device, "scene indices", indexList(g),
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    static_assert(sizeof(Triangle) == 16);
    triangles = makeBuffer(device, "scene triangles", triangleList(g), kTexelUsage);
    positions = makeBuffer(device, "scene positions", positionList(g),
                           kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | rayInput(device));
    rayTables = fovea::scene::rayTables(device, scene, g, positions, rays.device);
    previous = gpu::Buffer(device,
                           {"last positions of what moves", std::max(1u, movedVertices()) * sizeof(glm::vec4),
                            kTexelUsage | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                            gpu::MemoryKind::Device});
    attributes = makeBuffer(device, "scene attributes", attributeList(g), kTexelUsage);
    materials = makeBuffer(device, "scene materials", materialList(scene, g), kTexelUsage);
    block = sceneBlock(scene, g, full);
    if (rays.host) host.emplace(scene, g, fullMaterials);
  }
  ~Impl() {
    vkDestroyDescriptorPool(device.handle(), pool, nullptr);
    vkDestroyDescriptorSetLayout(device.handle(), layout, nullptr);
  }

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

std::vector<glm::vec4> GpuScene::Impl::materialList(const Scene& scene, const Geometry& g) {
  const auto place = [&](uint32_t texture) -> std::optional<glm::uvec3> {
    const TexturePages::Place* found = textures.find(texture);
    if (!found) return std::nullopt;
    return glm::uvec3(found->x, found->y, found->page);
  };
  MaterialTable table = materialTable(scene, g, fullMaterials, place);
  full = table.full;
  const uint64_t limit = device.limits().maxTexelBufferElements;
  if (table.texels.size() > limit && !device.lacks("maxTexelBufferElements"))
    throw Error(ExitCode::OutOfMemory,
                "scene materials: " + std::to_string(table.texels.size()) +
                    " elements exceed this device's maxTexelBufferElements " + std::to_string(limit),
                "use diffuse materials");
  return std::move(table.texels);
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
    entries[i] = objectRecord(i < frame.objects.size() ? frame.objects[i] : ObjectTransform{});
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
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 11 nodes that rays traverse, or an acceleration structure
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 12 triangles that rays hit
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,    // 13 light sources that rays are aimed at
};
constexpr uint32_t kBindingCount = uint32_t(std::size(kBindings));
constexpr uint32_t kTexelBindings =
    uint32_t(std::ranges::count(kBindings, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER));
constexpr uint32_t kRaySlot = 11;

// Storage buffers take the place of texel buffers where these are too small (device/texels.glsl).
VkDescriptorType typeOf(uint32_t binding, const gpu::Device& device) {
  if (binding == kRaySlot && !device.lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME))
    return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
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
  std::vector<VkDescriptorPoolSize> sizes;
  for (uint32_t i = 0; i < kBindingCount; ++i) sizes.push_back({typeOf(i, device), slots});
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = slots;
  poolInfo.poolSizeCount = uint32_t(sizes.size());
  poolInfo.pPoolSizes = sizes.data();
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
  const VkAccelerationStructureKHR structure = rayTables->structure();
  const VkWriteDescriptorSetAccelerationStructureKHR structureInfo{
      VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1, &structure};
  const Texels texels[kTexelBindings] = {{3, &triangles, kWords},
                                         {4, &positions},
                                         {5, &attributes},
                                         {6, &materials},
                                         {8, &objects[slot]},
                                         {9, &previous},
                                         {kRaySlot, rayTables->nodes(), kWords},
                                         {12, &rayTables->triangles(), kWords},
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
    if (!t.buffer) continue;
    wholes[i] = {t.buffer->handle(), 0, VK_WHOLE_SIZE};
    writes[t.binding].pBufferInfo = &wholes[i];
    if (writes[t.binding].descriptorType != VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) continue;
    views[i] = t.buffer->texelView(t.format);
    writes[t.binding].pTexelBufferView = &views[i];
  }
  writes[7].pImageInfo = &image;
  writes[10].pImageInfo = &environmentInfo;
  if (structure) writes[kRaySlot].pNext = &structureInfo;
  vkUpdateDescriptorSets(device.handle(), kBindingCount, writes, 0, nullptr);
}

GpuScene::GpuScene(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t framesInFlight,
                   bool fullMaterials, RaysWanted rays)
    : impl_(std::make_unique<Impl>(device, scene, geometry, fullMaterials, rays)) {
  const uint32_t slots = std::max(1u, framesInFlight);
  impl_->makeUniforms(slots);
  impl_->makeMoves(scene, geometry, slots);
  impl_->makeLayout();
  impl_->makeSets(slots);
}

GpuScene::~GpuScene() = default;

void GpuScene::update(const Frame& frame, uint32_t slot) {
  checkCount("views", frame.views.size(), kMaxViews);
  if (slot >= impl_->sets.size())
    throw Error(ExitCode::Internal, "no slot " + std::to_string(slot) + " of the scene");
  Impl& s = *impl_;
  impl_->store(slot, 0, frameBlock(s.block, frame));
  const std::vector<LightRecord> lights = lightRecords(frame.lights, frame.preExposure);
  std::memcpy(static_cast<std::byte*>(s.uniforms.mapped()) + slot * s.slotStride + s.lightOffset,
              lights.data(), lights.size() * sizeof(LightRecord));
  for (size_t i = 0; i < frame.views.size(); ++i)
    impl_->store(slot, s.viewOffset + i * s.viewStride, viewBlock(frame.views[i]));
  s.storeObjects(frame, slot);
  if (s.animator) s.animator->update(frame, slot);
}

const HostScene* GpuScene::host(const Frame& frame) {
  if (!impl_->host) return nullptr;
  impl_->host->update(frame);
  return &*impl_->host;
}

void GpuScene::recordMoves(VkCommandBuffer cmd, uint32_t slot) const {
  Impl& s = *impl_;
  if (!s.animator) return;
  s.animator->record(cmd, slot, s.positions, s.attributes, s.previous);
  s.rayTables->record(cmd);
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
RaysWanted GpuScene::rays() const { return impl_->rays; }
const std::vector<DrawRun>& GpuScene::drawRuns() const { return impl_->runs; }
uint32_t GpuScene::triangleCount() const { return impl_->triangleCount; }
uint32_t GpuScene::vertexCount() const { return impl_->vertexCount; }

}  // namespace fovea::scene
