// The command `fovea devices`: lists the devices that can render.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "framework/gpu/device.h"
#include "framework/graph/report/report.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

ExitCode printJson(const std::vector<gpu::DeviceInfo>& devices) {
  nlohmann::json all = nlohmann::json::array();
  for (const gpu::DeviceInfo& d : devices)
    all.push_back({{"index", d.index},
                   {"name", d.name},
                   {"type", d.type},
                   {"vulkan", d.apiVersion},
                   {"memory_bytes", d.memoryBytes},
                   {"driver", d.driver},
                   {"missing", d.missing},
                   {"without", d.without}});
  fmt::print("{}\n", all.dump(2));
  return ExitCode::Ok;
}

ExitCode listAll(bool asJson) {
  const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
  if (devices.empty())
    throw Error(ExitCode::NoDevice, "there is no Vulkan device",
                "install a driver; mesa-vulkan-drivers renders on the CPU");
  if (asJson) return printJson(devices);
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
  CLI::App* command = program.add_subcommand("devices", "List the Vulkan devices");
  auto asJson = std::make_shared<bool>(false);
  addJsonFlag(*command, *asJson);
  command->callback([asJson, &action] { action = [asJson] { return listAll(*asJson); }; });
}

}  // namespace fovea::cli
