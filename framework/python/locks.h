// Who may do what at the same time: Python's threads run at once while the framework works.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "fovea/device.h"

namespace fovea::python {

// Held by whoever reads or changes the list of passes: one thread at a time compiles a graph.
std::recursive_mutex& registryMutex();

// A device, which one thread at a time may use.
struct Device {
  explicit Device(std::shared_ptr<gpu::Device> opened) : gpu(std::move(opened)) {}

  std::shared_ptr<gpu::Device> gpu;
  std::mutex mutex{};
  std::atomic<std::thread::id> user{};

  // The device that this name and these features select. It is opened once, shared by all who ask for it, and stays open
  // until closeAll(), as opening it again would take longer than many a frame.
  static std::shared_ptr<Device> open(const std::string& name, const std::vector<std::string>& without);
  // To be called when Python ends; renderers that are left keep their device.
  static void closeAll();
  // Every open device looks at the files of shaders again.
  static void rereadShaders();
};

// The use of a device, for which other threads of Python run. Throws Error(Usage) in a pass or a function that a frame
// of the device itself calls, which would wait for its own end.
class DeviceUse {
 public:
  explicit DeviceUse(Device& device);
  ~DeviceUse() { device_.user = std::thread::id(); }
  DeviceUse(const DeviceUse&) = delete;
  DeviceUse& operator=(const DeviceUse&) = delete;

 private:
  Device& device_;
  nanobind::gil_scoped_release released_;
  std::unique_lock<std::mutex> lock_;
};

}  // namespace fovea::python
