// The facade fovea/device.h.
#include "framework/base/paths.h"
#include "framework/gpu/device.h"
#include "framework/gpu/shader/shader.h"

namespace fovea::gpu {
namespace {

std::shared_ptr<Device> withShaders(std::shared_ptr<Device> device) {
  for (const auto& folder : shaderFolders()) device->shaders().addSearchPath(folder);
  return device;
}

}  // namespace

std::shared_ptr<Device> openDevice(const DeviceOptions& options) {
  return withShaders(std::make_shared<Device>(options));
}

std::shared_ptr<Device> openDevice(const ExistingDevice& existing, const DeviceOptions& options) {
  return withShaders(std::make_shared<Device>(existing, options));
}

void rereadShaders(Device& device) { device.shaders().forget(); }

std::string nameOf(const Device& device) { return device.name(); }

}  // namespace fovea::gpu
