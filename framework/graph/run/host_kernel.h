// Kernels that are compiled for the host as well, from the same source as for the device: a step that traces rays runs
// there when the graph is bound with BoundGraph::raysOnHost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "fovea/pass.h"

namespace fovea::scene {
class HostScene;
}

namespace fovea::graph {

// A resource in memory of the host. Empty for a port that is not wired.
struct HostResource {
  std::span<std::byte> bytes;
  VkFormat format = VK_FORMAT_UNDEFINED;  // of an image
  uint32_t width = 0, height = 0;         // of an image, texels
  uint64_t rowBytes = 0;                  // of an image, from row to row
};

struct HostDispatch {
  const scene::HostScene* scene = nullptr;
  uint32_t view = 0;                                   // index into Frame::views
  std::array<uint32_t, 3> groups{}, groupSize{};       // numbers of work groups, and of invocations in each
  std::span<const std::byte> constants;                // the push constants
  std::span<uint64_t> counters;                        // of the pass, to be added to
  std::function<HostResource(std::string_view)> port;  // by the name of the binding
};

// Runs all invocations, on several threads, and returns when they are done.
using HostKernel = void (*)(const HostDispatch&);

// shader: folder and file, such as "blur/across.comp".
void addHostKernel(std::string shader, Defines defines, HostKernel kernel);
// shader: as in a step, which may be a path. Null if it is not compiled for the host with these macros.
HostKernel findHostKernel(const std::string& shader, const Defines& defines);

}  // namespace fovea::graph
