#include "framework/graph/run/host_steps.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/format.h"
#include "framework/graph/run/frame_slot.h"

namespace fovea::graph {
namespace {

constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
constexpr VkAccessFlags2 kAnyAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

// Calls use(access) for the ports that the kernel binds, and for the one that says how many groups of it there are.
template <class Use>
void forEachPort(const KernelState& kernel, std::optional<uint32_t> indirect, const Use& use) {
  for (const KernelBinding& b : kernel.bindings)
    if (b.source == KernelBinding::Source::Port) use(b.access);
  if (indirect) use(*indirect);
}

bool isShared(const PassInstance& pass, uint32_t access) {
  return pass.state->plan->graph->resources[pass.bound->accesses[access].resource].shared;
}

// copy: memory for what is not shared.
HostResource resourceOf(const PassInstance& pass, uint32_t access, const gpu::Buffer& copy) {
  const Access& a = pass.bound->accesses[access];
  const ResourceDesc& desc = pass.desc(a);
  HostResource resource;
  resource.format = desc.format;
  resource.width = desc.width;
  resource.height = desc.height;
  if (desc.kind == ResourceKind::Image)
    resource.rowBytes = uint64_t(desc.width) * gpu::formatInfo(desc.format).bytesPerTexel;
  std::byte* first = nullptr;
  if (!isShared(pass, access)) {
    first = static_cast<std::byte*>(copy.mapped());
  } else if (desc.kind == ResourceKind::Buffer) {
    first = static_cast<std::byte*>(pass.state->buffer(a).mapped());
  } else {
    const gpu::TexelRows& texels = pass.state->image(a).texels();
    first = texels.first;
    resource.rowBytes = texels.rowBytes;
  }
  resource.bytes = {first, size_t(resourceBytes(desc))};
  return resource;
}

}  // namespace

void HostSteps::prepare(PassInstance& pass) {
  for (const StepInstance& step : pass.steps) {
    if (!step.kernel || !step.kernel->host) continue;
    copies_.resize(pass.bound->accesses.size());
    std::optional<uint32_t> indirect;
    if (step.spec->sizing == StepSpec::Size::Indirect) indirect = accessOf(*pass.bound, step.spec->sizePort);
    forEachPort(*step.kernel, indirect, [&](uint32_t access) {
      const Access& a = pass.bound->accesses[access];
      if (copies_[access].memory || isShared(pass, access)) return;
      copies_[access].memory = gpu::Buffer(
          *pass.state->device,
          {"host copy of " + pass.state->plan->graph->resources[a.resource].name,
           std::max<uint64_t>(16, resourceBytes(pass.desc(a))),
           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback});
    });
  }
  contents_.resize(copies_.size());
}

void HostSteps::begin(const PassInstance& pass) {
  if (copies_.empty()) return;
  for (Copy& copy : copies_) copy.fresh = copy.written = false;
  for (size_t i = 0; i < contents_.size(); ++i) contents_[i] = pass.bound->accesses[i].reads;
  counters_.assign(pass.counterValues.size(), 0);
  milliseconds_ = waited_ = 0;
  idle_ = false;
}

void HostSteps::note(std::span<const StepAccess> accesses) {
  if (copies_.empty()) return;
  idle_ = false;
  for (const StepAccess& a : accesses)
    if (a.writes) {
      copies_[a.access].fresh = false;
      contents_[a.access] = 1;
    }
}

void HostSteps::bringToHost(PassInstance& pass, const KernelState& kernel, std::optional<uint32_t> indirect,
                            VkCommandBuffer& cmd) {
  const auto isMissing = [&](uint32_t i) { return !copies_[i].fresh && contents_[i] && !isShared(pass, i); };
  bool missing = false;
  forEachPort(kernel, indirect, [&](uint32_t i) { missing = missing || isMissing(i); });
  if (idle_ && !missing) return;
  gpu::memoryBarrier(cmd, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT, kAnyAccess);
  forEachPort(kernel, indirect, [&](uint32_t i) {
    if (!isMissing(i)) return;
    copies_[i].fresh = true;
    const Access& a = pass.bound->accesses[i];
    copyToStaging(cmd, pass.state->resources[a.resource], pass.state->copyIndex(a), a.layout,
                  copies_[i].memory, resourceBytes(pass.desc(a)));
  });
  gpu::memoryBarrier(cmd, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                     VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
  const auto submitted = Clock::now();
  cmd = pass.state->finishAndBegin();
  waited_ += millisecondsSince(submitted);
  idle_ = true;
}

void HostSteps::run(PassInstance& pass, const KernelState& kernel, std::span<const std::byte> constants,
                    std::array<uint32_t, 3> groups, std::optional<uint32_t> indirect, uint64_t offset,
                    VkCommandBuffer& cmd) {
  bringToHost(pass, kernel, indirect, cmd);
  if (indirect)
    std::memcpy(groups.data(), resourceOf(pass, *indirect, copies_[*indirect].memory).bytes.data() + offset,
                sizeof groups);
  const auto start = Clock::now();
  HostDispatch dispatch;
  dispatch.scene = pass.state->hostScene;
  dispatch.view = pass.viewIndex;
  dispatch.groups = groups;
  std::ranges::copy(kernel.pipeline->interface().localSize, dispatch.groupSize.begin());
  dispatch.constants = constants;
  dispatch.counters = counters_;
  const auto port = [&](std::string_view name) -> HostResource {
    for (const KernelBinding& b : kernel.bindings)
      if (b.source == KernelBinding::Source::Port && b.reflected.name == name)
        return resourceOf(pass, b.access, copies_[b.access].memory);
    return {};
  };
  dispatch.port = std::cref(port);  // which, unlike a copy, takes no memory
  kernel.host(dispatch);
  milliseconds_ += millisecondsSince(start);
  for (const StepAccess& a : kernel.accesses)
    if (a.writes) {
      copies_[a.access].fresh = copies_[a.access].written = true;
      contents_[a.access] = 1;
    }
}

bool HostSteps::bringToDevice(PassInstance& pass, VkCommandBuffer cmd) {
  if (std::ranges::none_of(copies_, [](const Copy& copy) { return copy.written; })) return false;
  gpu::memoryBarrier(cmd, kAll, kAnyAccess, VK_PIPELINE_STAGE_2_COPY_BIT, kAnyAccess);
  for (size_t i = 0; i < copies_.size(); ++i) {
    if (!copies_[i].written) continue;
    copies_[i].written = false;
    if (isShared(pass, uint32_t(i))) continue;
    const Access& a = pass.bound->accesses[i];
    copyFromStaging(cmd, pass.state->resources[a.resource], pass.state->copyIndex(a), a.layout,
                    copies_[i].memory, resourceBytes(pass.desc(a)));
  }
  gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kAll, kAnyAccess);
  return true;
}

}  // namespace fovea::graph
