#include "framework/graph/pass/derive.h"

#include <algorithm>

namespace fovea::graph {
namespace {

Usage usageOf(const PassDeclaration& d, const PortSpec& port, const MemberSpec& m, const std::string& path) {
  using Action = StepSpec::Action;
  const bool image = m.resource.kind == ResourceKind::Image, reads = port.direction == Direction::Input,
             scratch = port.direction == Direction::Scratch;
  if (d.kind == PassKind::Host)
    return reads                                ? Usage::HostRead
           : port.direction == Direction::InOut ? Usage::HostRead | Usage::HostWrite
                                                : Usage::HostWrite;
  Usage usage = Usage::None;
  bool attachment = false;
  for (const StepSpec& step : d.steps) {
    const bool target = std::find(step.targets.begin(), step.targets.end(), path) != step.targets.end();
    attachment |= target && step.action == Action::Fullscreen;
    if (target && step.action != Action::Fullscreen) usage = usage | Usage::TransferWrite;
    if (step.action == Action::Copy && step.source == path) usage = usage | Usage::TransferRead;
    if (step.tileMask == path) usage = usage | Usage::StorageRead;
    if (step.sizing == StepSpec::Size::Indirect && step.sizePort == path) usage = usage | Usage::Indirect;
  }
  if (attachment) usage = usage | Usage::ColorAttachment;
  if (reads) return usage | (image ? Usage::Sampled : Usage::StorageRead | Usage::TexelRead);
  if (scratch) usage = usage | (image ? Usage::Sampled : Usage::TexelRead);
  if (image && attachment) return usage;
  return usage | Usage::StorageRead | Usage::StorageWrite;
}

}  // namespace

void deriveKind(PassDeclaration& d) {
  bool compute = false, graphics = false;
  for (const StepSpec& step : d.steps)
    (step.action == StepSpec::Action::Fullscreen ? graphics : compute) = true;
  d.kind = !graphics ? PassKind::Compute : compute ? PassKind::ComputeAndGraphics : PassKind::Graphics;
}

void deriveUsages(PassDeclaration& d) {
  for (PortSpec& port : d.ports)
    for (MemberSpec& m : port.members)
      if (m.usage == Usage::None) m.usage = usageOf(d, port, m, memberPath(port, m));
}

}  // namespace fovea::graph
