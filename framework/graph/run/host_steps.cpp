#include "framework/graph/run/host_steps.h"

#include <algorithm>
#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/format.h"
#include "framework/graph/run/frame_slot.h"

namespace fovea::graph {
namespace {

constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
constexpr VkAccessFlags2 kAnyAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

std::vector<uint32_t> portsOf(const KernelState& kernel) {
  std::vector<uint32_t> accesses;
  for (const KernelBinding& b : kernel.bindings)
    if (b.source == KernelBinding::Source::Port) accesses.push_back(b.access);
  return accesses;
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
    std::vector<uint32_t> accesses = portsOf(*step.kernel);
    if (step.spec->sizing == StepSpec::Size::Indirect)
      accesses.push_back(accessOf(*pass.bound, step.spec->sizePort));
    for (const uint32_t access : accesses) {
      const Access& a = pass.bound->accesses[access];
      if (copies_[access].memory || isShared(pass, access)) continue;
      copies_[access].memory = gpu::Buffer(
          *pass.state->device,
          {"host copy of " + pass.state->plan->graph->resources[a.resource].name,
           std::max<uint64_t>(16, resourceBytes(pass.desc(a))),
           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback});
    }
  }
  contents_.resize(copies_.size());
}

void HostSteps::begin(const PassInstance& pass) {
  if (copies_.empty()) return;
  for (Copy& copy : copies_) copy.fresh = copy.written = false;
  for (size_t i = 0; i < contents_.size(); ++i) contents_[i] = pass.bound->accesses[i].reads;
  counters_.assign(pass.counterValues.size(), 0);
  milliseconds_ = waited_ = 0;
}

void HostSteps::note(std::span<const StepAccess> accesses) {
  if (copies_.empty()) return;
  for (const StepAccess& a : accesses)
    if (a.writes) {
      copies_[a.access].fresh = false;
      contents_[a.access] = 1;
    }
}

void HostSteps::bringToHost(PassInstance& pass, std::span<const uint32_t> accesses, VkCommandBuffer cmd) {
  gpu::memoryBarrier(cmd, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT, kAnyAccess);
  for (const uint32_t i : accesses) {
    Copy& copy = copies_[i];
    if (copy.fresh || isShared(pass, i)) continue;
    copy.fresh = true;
    if (!contents_[i]) continue;
    const Access& a = pass.bound->accesses[i];
    copyToStaging(cmd, pass.state->resources[a.resource], pass.state->copyIndex(a), a.layout, copy.memory,
                  resourceBytes(pass.desc(a)));
  }
  gpu::memoryBarrier(cmd, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                     VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
}

void HostSteps::run(PassInstance& pass, const KernelState& kernel, std::span<const std::byte> constants,
                    std::array<uint32_t, 3> groups, std::optional<uint32_t> indirect, uint64_t offset,
                    VkCommandBuffer& cmd) {
  std::vector<uint32_t> accesses = portsOf(kernel);
  if (indirect) accesses.push_back(*indirect);
  bringToHost(pass, accesses, cmd);
  const auto submitted = Clock::now();
  cmd = pass.state->finishAndBegin();
  waited_ += millisecondsSince(submitted);
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
  dispatch.port = [&](std::string_view name) -> HostResource {
    for (const KernelBinding& b : kernel.bindings)
      if (b.source == KernelBinding::Source::Port && b.reflected.name == name)
        return resourceOf(pass, b.access, copies_[b.access].memory);
    return {};
  };
  kernel.host(dispatch);
  milliseconds_ += millisecondsSince(start);
  for (const StepAccess& a : kernel.accesses)
    if (a.writes) {
      copies_[a.access].written = true;
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
