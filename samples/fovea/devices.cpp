// The command `fovea devices`: lists the devices that can render.
#include <fmt/format.h>

#include <algorithm>

#include "framework/gpu/device.h"
#include "framework/graph/report/report.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

ExitCode listAll() {
  const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
  if (devices.empty())
    throw Error(ExitCode::NoDevice, "there is no Vulkan device",
                "install a driver; mesa-vulkan-drivers renders on the CPU");
  size_t name = 4, type = 4;
  for (const gpu::DeviceInfo& d : devices) {
    name = std::max(name, d.name.size());
    type = std::max(type, d.type.size());
  }
  fmt::print("{:>2}  {:<{}}  {:<{}}  {:<8}  {:>9}  {}\n", "#", "name", name, "type", type, "Vulkan", "memory",
             "driver");
  for (const gpu::DeviceInfo& d : devices) {
    fmt::print("{:>2}  {:<{}}  {:<{}}  {:<8}  {:>9}  {}\n", d.index, d.name, name, d.type, type, d.apiVersion,
               graph::printBytes(d.memoryBytes), d.driver);
    if (!d.missing.empty()) fmt::print("    unusable, it lacks {}\n", quoteList(d.missing));
    if (!d.without.empty()) fmt::print("    works without {}\n", quoteList(d.without));
  }
  return ExitCode::Ok;
}

}  // namespace

void addDevices(CLI::App& program, Action& action) {
  program.add_subcommand("devices", "List the Vulkan devices")->callback([&action] { action = listAll; });
}

}  // namespace fovea::cli
