#include "framework/gpu/rays/acceleration_structure.h"

#include <algorithm>
#include <utility>

#include "framework/gpu/device.h"

namespace fovea::gpu {
namespace {

// The functions of the extension, which the loader does not export.
struct Functions {
  PFN_vkCreateAccelerationStructureKHR create;
  PFN_vkDestroyAccelerationStructureKHR destroy;
  PFN_vkGetAccelerationStructureBuildSizesKHR sizes;
  PFN_vkGetAccelerationStructureDeviceAddressKHR address;
  PFN_vkCmdBuildAccelerationStructuresKHR build;

  explicit Functions(VkDevice device) {
    load(device, create, "vkCreateAccelerationStructureKHR");
    load(device, destroy, "vkDestroyAccelerationStructureKHR");
    load(device, sizes, "vkGetAccelerationStructureBuildSizesKHR");
    load(device, address, "vkGetAccelerationStructureDeviceAddressKHR");
    load(device, build, "vkCmdBuildAccelerationStructuresKHR");
  }

 private:
  template <class F>
  static void load(VkDevice device, F& function, const char* name) {
    function = reinterpret_cast<F>(vkGetDeviceProcAddr(device, name));
  }
};

VkDeviceAddress addressOf(VkDevice device, const Buffer& buffer) {
  const VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr,
                                       buffer.handle()};
  return vkGetBufferDeviceAddress(device, &info);
}

uint64_t scratchAlignment(const Device& device) {
  VkPhysicalDeviceAccelerationStructurePropertiesKHR structures{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &structures};
  vkGetPhysicalDeviceProperties2(device.physical(), &all);
  return std::max(structures.minAccelerationStructureScratchOffsetAlignment, 1u);
}

}  // namespace

struct AccelerationStructure::Impl {
  Device& device;
  Functions functions;
  VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  VkAccelerationStructureBuildGeometryInfoKHR info{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
  VkAccelerationStructureBuildRangeInfoKHR range{};
  Buffer storage, scratch;
  VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
  VkDeviceAddress address = 0;

  explicit Impl(Device& d) : device(d), functions(d.handle()) {}
  ~Impl() {
    if (handle) functions.destroy(device.handle(), handle, nullptr);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // `geometry`, `range` and the type and flags of `info` have been filled in.
  void create(const std::string& name) {
    info.geometryCount = 1;
    info.pGeometries = &geometry;
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    functions.sizes(device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info,
                    &range.primitiveCount, &sizes);
    storage = Buffer(device, {name, std::max<uint64_t>(sizes.accelerationStructureSize, 1),
                              VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                                  VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                              MemoryKind::Device});
    const uint64_t alignment = scratchAlignment(device);
    scratch = Buffer(
        device,
        {name + ", scratch", std::max(sizes.buildScratchSize, sizes.updateScratchSize) + alignment,
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, MemoryKind::Device});
    VkAccelerationStructureCreateInfoKHR createInfo{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    createInfo.buffer = storage.handle();
    createInfo.size = sizes.accelerationStructureSize;
    createInfo.type = info.type;
    check(functions.create(device.handle(), &createInfo, nullptr, &handle),
          "creating the acceleration structure `" + name + "`");
    device.setName(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(handle), name);
    const VkAccelerationStructureDeviceAddressInfoKHR addressInfo{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, nullptr, handle};
    address = functions.address(device.handle(), &addressInfo);
    info.dstAccelerationStructure = handle;
    const VkDeviceAddress begin = addressOf(device.handle(), scratch);
    info.scratchData.deviceAddress = (begin + alignment - 1) / alignment * alignment;
  }

  void record(VkCommandBuffer cmd, VkBuildAccelerationStructureModeKHR mode) {
    info.mode = mode;
    info.srcAccelerationStructure =
        mode == VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR ? handle : VK_NULL_HANDLE;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    functions.build(cmd, 1, &info, &ranges);
  }
};

AccelerationStructure::AccelerationStructure(Device& device, const std::string& name,
                                             const TriangleInput& triangles, bool moves)
    : impl_(std::make_unique<Impl>(device)) {
  Impl& s = *impl_;
  s.geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
  if (triangles.opaque) s.geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
  VkAccelerationStructureGeometryTrianglesDataKHR& data = s.geometry.geometry.triangles;
  data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
  data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
  data.vertexData.deviceAddress = addressOf(device.handle(), *triangles.positions);
  data.vertexStride = 4 * sizeof(float);
  data.maxVertex = std::max(triangles.vertices, 1u) - 1;
  data.indexType = VK_INDEX_TYPE_UINT32;
  data.indexData.deviceAddress = addressOf(device.handle(), *triangles.indices);
  s.range.primitiveCount = triangles.count;
  s.range.primitiveOffset = triangles.first * uint32_t(3 * sizeof(uint32_t));
  s.info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
  s.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  if (moves) s.info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
  s.create(name);
}

AccelerationStructure::AccelerationStructure(Device& device, const std::string& name, const Buffer& instances,
                                             uint32_t count)
    : impl_(std::make_unique<Impl>(device)) {
  Impl& s = *impl_;
  s.geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  VkAccelerationStructureGeometryInstancesDataKHR& data = s.geometry.geometry.instances;
  data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  data.data.deviceAddress = addressOf(device.handle(), instances);
  s.range.primitiveCount = count;
  s.info.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  s.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  s.create(name);
}

AccelerationStructure::AccelerationStructure() noexcept = default;
AccelerationStructure::AccelerationStructure(AccelerationStructure&&) noexcept = default;
AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&&) noexcept = default;
AccelerationStructure::~AccelerationStructure() = default;

void AccelerationStructure::build(VkCommandBuffer cmd) {
  impl_->record(cmd, VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR);
}

void AccelerationStructure::update(VkCommandBuffer cmd) {
  impl_->record(cmd, VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR);
}

VkAccelerationStructureKHR AccelerationStructure::handle() const { return impl_->handle; }
VkDeviceAddress AccelerationStructure::address() const { return impl_->address; }

}  // namespace fovea::gpu
