#include "framework/graph/steps/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "fovea/error.h"
#include "framework/graph/pass/validate.h"
#include "framework/scene/frame.h"

namespace fovea::graph {
namespace {

Usage without(Usage all, Usage some) { return Usage(uint32_t(all) & ~uint32_t(some)); }

AccessScope scopeOf(const StepAccess& a) { return {a.stage, a.mask}; }

}  // namespace

Usage usageOf(gpu::BindingKind kind) {
  switch (kind) {
    case gpu::BindingKind::UniformBuffer:
      return Usage::Uniform;
    case gpu::BindingKind::UniformTexelBuffer:
      return Usage::TexelRead;
    case gpu::BindingKind::SampledImage:
    case gpu::BindingKind::CombinedImageSampler:
      return Usage::Sampled;
    default:
      return Usage::StorageRead | Usage::StorageWrite;
  }
}

// ---- What a step does --------------------------------------------------------------------------------

StepAccess portAccess(const BoundPass& pass, uint32_t access, Usage usage, PassKind stages) {
  const bool writes = any(usage, kWriteUsages) && pass.accesses[access].writes;
  // An attachment may be loaded, tested or blended.
  const bool reads = any(usage, kReadUsages | Usage::ColorAttachment | Usage::DepthAttachment);
  const AccessScope scope = accessScope(stages, usage, reads, writes);
  return {access, scope.stage, scope.access, reads, writes};
}

StepAccess bindingAccess(const BoundPass& pass, uint32_t access, const gpu::ReflectedBinding& binding,
                         PassKind stages) {
  Usage usage = Usage(uint32_t(pass.accesses[access].usage) & uint32_t(usageOf(binding.kind)));
  // A port that only reads is not written, whatever the shader could do.
  if (binding.readOnly || !pass.accesses[access].writes) usage = without(usage, Usage::StorageWrite);
  // Where texel buffers are too small, storage buffers take their place (device/texels.glsl).
  if (binding.kind == gpu::BindingKind::StorageBuffer && binding.readOnly && !any(usage, Usage::StorageRead))
    usage = usage | Usage(uint32_t(pass.accesses[access].usage) & uint32_t(Usage::TexelRead));
  if (binding.writeOnly) usage = without(usage, Usage::StorageRead);
  return portAccess(pass, access, usage, stages);
}

std::string bindingName(std::string_view inShader) {
  std::string name(inShader);
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

uint32_t accessOfBinding(const BoundPass& pass, std::string_view binding) {
  const std::string name = bindingName(binding);
  const std::vector<std::string> paths = wiredPaths(pass);
  const auto found = std::find_if(paths.begin(), paths.end(),
                                  [&](const std::string& path) { return shaderName(path) == name; });
  return found == paths.end() ? kNone : static_cast<uint32_t>(found - paths.begin());
}

std::vector<StepAccess> shaderAccesses(const BoundPass& pass, std::span<const gpu::ReflectedBinding> bindings,
                                       PassKind stages) {
  std::vector<StepAccess> accesses;
  for (const gpu::ReflectedBinding& b : bindings) {
    const uint32_t access = b.set == 0 ? accessOfBinding(pass, b.name) : kNone;
    if (access == kNone) continue;
    accesses.push_back(bindingAccess(pass, access, b, stages));
  }
  return accesses;
}

gpu::Defines stepDefines(const StepSpec& step, const PassContext& context) {
  gpu::Defines defines;
  for (const auto& [macro, value] : step.defines) defines[macro] = std::to_string(context.evaluate(value));
  if (context.has(step.tileMask))
    defines["FOVEA_TILE_MASK"] = shaderName(step.tileMask);  // device/fullscreen.vert
  return defines;
}

// ---- The order of steps ------------------------------------------------------------------------------

StepTracker::StepTracker(const BoundPass& pass) {
  std::vector<std::pair<uint32_t, bool>> known;
  for (const Access& a : pass.accesses) {
    const std::pair<uint32_t, bool> copy{a.resource, a.previous};
    const auto found = std::find(known.begin(), known.end(), copy);
    copyOf_.push_back(static_cast<uint32_t>(found - known.begin()));
    if (found == known.end()) known.push_back(copy);
  }
  copies_.resize(known.size());
}

void StepTracker::reset() { std::fill(copies_.begin(), copies_.end(), Copy()); }

// The commands that ran together become part of the past.
void StepTracker::enter(Copy& copy) {
  if (copy.writtenBy.stage) {
    beforeWrite(copy.past,
                {copy.writtenBy.stage | copy.readBy.stage, copy.writtenBy.access | copy.readBy.access},
                copy.reads || copy.readBy.stage);
  } else if (copy.readBy.stage) {
    beforeRead(copy.past, copy.readBy);
  }
  copy.readBy = copy.writtenBy = {};
  copy.reads = false;
}

Dependency StepTracker::before(std::span<const StepAccess> accesses, bool together) {
  if (!together)
    for (Copy& copy : copies_) enter(copy);
  Dependency wait;
  for (const StepAccess& a : accesses) {
    Copy& copy = copies_[copyOf_[a.access]];
    AccessHistory history = copy.past;
    wait |= a.writes ? beforeWrite(history, scopeOf(a), a.reads) : beforeRead(history, scopeOf(a));
    AccessScope& scope = a.writes ? copy.writtenBy : copy.readBy;
    scope.stage |= a.stage;
    scope.access |= a.mask;
    copy.reads |= a.writes && a.reads;
  }
  if (wait)
    for (Copy& copy : copies_) settle(copy.past, wait);
  return wait;
}

namespace {

StepAccess attachment(const BoundPass& pass, const std::string& path) {
  return portAccess(pass, accessOf(pass, path), Usage::ColorAttachment, PassKind::Graphics);
}

[[noreturn]] void wrongStep(const BoundPass& pass, const std::string& place, const std::string& message,
                            const std::string& remedy) {
  const PassDeclaration& d = *pass.declaration;
  throw Error(ExitCode::BadInput, {{Severity::Error, d.placeOf(place), d.places ? place : "",
                                    fmt::format("pass `{}` ({}): {}", pass.name, d.type, message), remedy}});
}

// Every binding must be something that the framework can bind. Steps without a size are completed by the pass, which
// may bind more.
void checkBindings(const BoundPass& pass, const StepSpec& step, const gpu::CompiledShader& shader) {
  if (step.action == StepSpec::Action::Dispatch && step.sizing == StepSpec::Size::Manual) return;
  for (const gpu::ReflectedBinding& b : shader.reflection.bindings) {
    if (b.set != 0 || b.kind == gpu::BindingKind::Sampler || bindingName(b.name) == "counters" ||
        accessOfBinding(pass, b.name) != kNone)
      continue;
    std::vector<std::string> names;
    for (const PortSpec& port : pass.declaration->ports)
      for (const MemberSpec& m : port.members) names.push_back(shaderName(memberPath(port, m)));
    const bool declared = std::find(names.begin(), names.end(), b.name) != names.end();
    if (declared && !pass.declaration->places)
      continue;  // prepare() says it better, or the command that needs it
    const std::string nearest = declared ? "" : nearestName(b.name, names);
    wrongStep(pass, "steps." + step.name,
              fmt::format("step `{}`: the shader {} binds `{}`, which is {}", step.name, shader.file, b.name,
                          declared ? "an input that is not wired" : "no port of the pass"),
              declared ? "put the binding and its use between #if and #endif, on a define such as wired(PORT)"
              : nearest.empty() ? "name bindings after ports: `surface.position` is surfacePosition"
                                : fmt::format("did you mean `{}`?", nearest));
  }
}

// A pass that is declared in a file has no code that could set a push constant.
void checkConstants(const BoundPass& pass, const StepSpec& step, const gpu::CompiledShader& shader) {
  if (!pass.declaration->places) return;
  std::vector<std::string> given = {"frameIndex", "seed", "foveaRadius"}, found;
  for (const ParameterSpec& parameter : pass.declaration->parameters)
    if (parameter.type != ParameterSpec::Type::Text) given.push_back(shaderName(parameter.name));
  for (const auto& [name, value] : step.constants) given.push_back(name);
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto wrong = [&](const std::string& name, const char* what, const std::vector<std::string>& names,
                         const char* remedy) {
    const std::string nearest = nearestName(name, names);
    wrongStep(pass, "steps." + step.name,
              fmt::format("step `{}`: the shader {} {}", step.name, shader.file,
                          fmt::format(fmt::runtime(what), name)),
              nearest.empty() ? remedy : fmt::format("did you mean `{}`?", nearest));
  };
  for (const gpu::ReflectedMember& constant : shader.reflection.constants) {
    found.push_back(constant.name);
    if (!has(given, constant.name))
      wrong(constant.name, "has the push constant `{}`, which nothing sets", given,
            "name it after a parameter, set it in \"constant\" of the step, or remove it");
  }
  for (const auto& [name, value] : step.constants)
    if (!has(found, name))
      wrong(name, "reads no push constant `{}`, which the step sets", found, "remove it from \"constant\"");
}

bool mentions(const SizeExpr& expression, const PortSpec& port) {
  return std::any_of(expression.terms().begin(), expression.terms().end(), [&](const SizeExpr::Term& term) {
    return term.op >= SizeExpr::Op::PortWidth && term.op <= SizeExpr::Op::PortCount &&
           term.name.substr(0, term.name.find('.')) == port.name;
  });
}

// Whether the size of the port decides on the size of something.
bool givesSize(const PassDeclaration& d, const PortSpec& port) {
  for (const PortSpec& other : d.ports)
    for (const MemberSpec& m : other.members)
      for (const SizeExpr* e : {&m.resource.width, &m.resource.height, &m.resource.depth, &m.resource.layers,
                                &m.resource.mips, &m.resource.count})
        if (mentions(*e, port)) return true;
  for (const StepSpec& step : d.steps)
    for (const SizeExpr& e : step.size)
      if (mentions(e, port)) return true;
  return false;
}

// In a file, a port that no step uses is a mistake, such as a binding of another name.
void checkPorts(const BoundPass& pass, const std::vector<uint8_t>& used) {
  for (uint32_t i = 0; i < pass.accesses.size(); ++i) {
    const PortSpec& port = pass.declaration->ports[pass.accesses[i].port];
    if (used[i] || givesSize(*pass.declaration, port)) continue;
    const std::string path = memberPath(port, port.members[pass.accesses[i].member]);
    wrongStep(pass, "ports." + port.name, fmt::format("no step uses the port `{}`", path),
              fmt::format("bind it in a shader as `{}`, or remove it", shaderName(path)));
  }
}

std::vector<StepAccess> accessesOf(const BoundPass& pass, const StepSpec& step, const PassContext& context,
                                   const ShaderLookup& shaders) {
  using Action = StepSpec::Action;
  const auto transfer = [&](const std::string& path, Usage usage) {
    return portAccess(pass, accessOf(pass, path), usage, PassKind::Compute);
  };
  switch (step.action) {
    case Action::Fill:
    case Action::Clear:
      return {transfer(step.targets[0], Usage::TransferWrite)};
    case Action::Copy:
      return {transfer(step.source, Usage::TransferRead), transfer(step.targets[0], Usage::TransferWrite)};
    case Action::Dispatch:
    case Action::Fullscreen:
      break;
  }
  const PassKind stages = step.action == Action::Dispatch ? PassKind::Compute : PassKind::Graphics;
  const auto shader = shaders(step.shader, stepDefines(step, context));
  checkBindings(pass, step, *shader);
  checkConstants(pass, step, *shader);
  std::vector<StepAccess> accesses = shaderAccesses(pass, shader->reflection.bindings, stages);
  for (const std::string& target : step.targets) accesses.push_back(attachment(pass, target));
  if (context.has(step.tileMask))
    accesses.push_back(portAccess(pass, accessOf(pass, step.tileMask), Usage::StorageRead, stages));
  if (step.sizing == StepSpec::Size::Indirect)
    accesses.push_back(portAccess(pass, accessOf(pass, step.sizePort), Usage::Indirect, stages));
  return accesses;
}

// Memory that belongs to the pass holds nothing when a frame starts, unless it is kept.
void checkRead(const BoundPass& pass, const StepSpec& step, const StepAccess& access,
               const std::vector<uint8_t>& written) {
  const PortSpec& port = pass.declaration->ports[pass.accesses[access.access].port];
  const bool own = port.direction == Direction::Scratch || port.direction == Direction::Output;
  if (access.writes || written[access.access] || !own || port.lifetime != Lifetime::Transient) return;
  wrongStep(pass, "steps." + step.name,
            fmt::format("step `{}` reads `{}`, which no step before it has written", step.name, port.name),
            "write or fill it in an earlier step, or keep it from frame to frame");
}

// Whether the step traces rays, and on the host.
void chooseProcessor(const BoundGraph& graph, const BoundPass& pass, const StepSpec& step,
                     const PassContext& context, const ShaderLookup& shaders, PlannedStep& planned) {
  if (!pass.declaration->tracesRays || step.action != StepSpec::Action::Dispatch) return;
  const gpu::Defines defines = stepDefines(step, context);
  planned.tracesRays = tracesRays(*shaders(step.shader, defines));
  if (planned.tracesRays && graph.raysOnHost) planned.host = findHostKernel(step.shader, defines);
}

}  // namespace

bool tracesRays(const gpu::CompiledShader& shader) {
  return std::ranges::any_of(shader.reflection.bindings, [](const gpu::ReflectedBinding& b) {
    return b.set == 1 && b.name.starts_with(scene::kRayBinding);
  });
}

std::vector<PlannedStep> planSteps(const BoundGraph& graph, const BoundPass& pass,
                                   const ShaderLookup& shaders) {
  const PassContext context(graph, pass);
  StepTracker tracker(pass);
  std::vector<uint8_t> written(pass.accesses.size()), used(pass.accesses.size());
  std::vector<PlannedStep> planned;
  const std::vector<StepSpec>& steps = pass.declaration->steps;
  for (uint32_t i = 0; i < steps.size(); ++i) {
    if (context.evaluate(steps[i].condition) == 0) continue;
    PlannedStep step{i, {}, accessesOf(pass, steps[i], context, shaders)};
    chooseProcessor(graph, pass, steps[i], context, shaders, step);
    if (pass.declaration->stepsByFrame) {
      planned.push_back(std::move(step));
      continue;
    }
    for (const StepAccess& a : step.accesses) checkRead(pass, steps[i], a, written);
    for (const StepAccess& a : step.accesses) {
      written[a.access] |= uint8_t(a.writes);
      used[a.access] = 1;
    }
    step.before = tracker.before(step.accesses, steps[i].together);
    planned.push_back(std::move(step));
  }
  const bool declaredInFile = pass.declaration->places && pass.declaration->kind != PassKind::Host;
  if (declaredInFile && planned.size() == steps.size()) checkPorts(pass, used);
  return planned;
}

}  // namespace fovea::graph
