// Steps of a pass: what each of them does to the resources of the pass, and what it waits for.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/shader/shader.h"
#include "framework/graph/compile/hazards.h"

namespace fovea::graph {

// Follows the commands of one pass in order. The same rule places the barriers of a plan and those of commands that a
// pass records by itself.
class StepTracker {
 public:
  explicit StepTracker(const BoundPass& pass);
  // Forgets everything, as at the start of the pass and after a barrier for all memory.
  void reset();
  // What a command has to wait for. With `together`, it does not wait for the command before it, nor for others that
  // run together with that one.
  Dependency before(std::span<const StepAccess> accesses, bool together = false);

 private:
  // One copy of a resource, which several ports may reach.
  struct Copy {
    AccessHistory past;  // up to the commands that may still be running together
    AccessScope readBy, writtenBy;
    bool reads = false;  // whether one of the writers reads, too
  };
  void enter(Copy& copy);
  std::vector<uint32_t> copyOf_;  // per access of the pass
  std::vector<Copy> copies_;
};

// What a shader does through its bindings of set 0, so far as the ports allow it. Bindings that are no ports are left
// out.
std::vector<StepAccess> shaderAccesses(const BoundPass& pass, std::span<const gpu::ReflectedBinding> bindings,
                                       PassKind stages);
// The same for a single binding and the port that it is bound to.
StepAccess bindingAccess(const BoundPass& pass, uint32_t access, const gpu::ReflectedBinding& binding,
                         PassKind stages);
// An access through a port for one of its usages.
StepAccess portAccess(const BoundPass& pass, uint32_t access, Usage usage, PassKind stages);

// The usages through which a shader can reach a port by a binding of this kind.
Usage usageOf(gpu::BindingKind kind);

// A block without an instance name goes by the name of the block, which starts with a capital: `buffer Total {...};` is
// "total".
std::string bindingName(std::string_view inShader);
// The access that a binding's name refers to: "surfacePosition" for surface.position; kNone if there is none.
uint32_t accessOfBinding(const BoundPass& pass, std::string_view binding);

// The preprocessor macros of a step of this pass.
gpu::Defines stepDefines(const StepSpec& step, const PassContext& context);

// Whether a shader traces rays through the tables that the scene has on the device.
bool tracesRays(const gpu::CompiledShader& shader);

// How planSteps() reads a shader.
using ShaderLookup =
    std::function<std::shared_ptr<const gpu::CompiledShader>(const std::string& file, const gpu::Defines&)>;

// The declared steps of a pass whose conditions hold, with what each waits for. Throws Error(BadInput) for shaders that
// do not compile, and for a step that reads memory of the pass which no step has written.
std::vector<PlannedStep> planSteps(const BoundGraph& graph, const BoundPass& pass,
                                   const ShaderLookup& shaders);

}  // namespace fovea::graph
