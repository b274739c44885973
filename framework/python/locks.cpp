#include "framework/python/locks.h"

#include <map>

#include "fovea/error.h"

namespace fovea::python {

std::recursive_mutex& registryMutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

namespace {

// Open devices by their name and the features that they do without. The registry's mutex guards it.
std::map<std::pair<std::string, std::vector<std::string>>, std::shared_ptr<Device>> openDevices;

}  // namespace

void Device::rereadShaders() {
  const std::lock_guard lock(registryMutex());
  for (const auto& [name, device] : openDevices) gpu::rereadShaders(*device->gpu);
}

void Device::closeAll() {
  const std::lock_guard lock(registryMutex());
  openDevices.clear();
}

std::shared_ptr<Device> Device::open(const std::string& name, const std::vector<std::string>& without) {
  const std::lock_guard lock(registryMutex());
  const auto known = openDevices.find({name, without});
  if (known != openDevices.end()) return known->second;
  auto device = std::make_shared<Device>(gpu::openDevice({.device = name, .without = without}));
  openDevices.emplace(std::pair(name, without), device);
  return device;
}

DeviceUse::DeviceUse(Device& device) : device_(device), lock_(device.mutex, std::defer_lock) {
  if (device.user == std::this_thread::get_id())
    throw Error(ExitCode::Usage,
                "a pass or a function that a frame calls cannot use the device of that frame",
                "render the other frame before or after this one, or on a thread of its own");
  lock_.lock();
  device_.user = std::this_thread::get_id();
}

}  // namespace fovea::python
