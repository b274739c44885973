// Merges the reflections of a pipeline's stages; needs no device.
#include <algorithm>
#include <map>
#include <set>

#include "fovea/error.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/shader/spirv_bindings.h"

namespace fovea::gpu {
namespace {

[[noreturn]] void contradiction(const CompiledShader& shader, const std::string& what) {
  throw Error(ExitCode::BadInput, {{Severity::Error, {shader.file, 0, 0}, {}, what, {}}});
}

// The entry of `b` among those of earlier stages, or null.
ReflectedBinding* findByName(PipelineInterface& interface, const ReflectedBinding& b) {
  for (ReflectedBinding& other : interface.bindings) {
    if (other.name == b.name) return &other;
  }
  return nullptr;
}

void mergeSame(const CompiledShader& shader, ReflectedBinding& into, const ReflectedBinding& b) {
  if (into.kind != b.kind || into.count != b.count)
    contradiction(shader, "`" + b.name + "` is another kind of resource in an earlier stage");
  if (!into.automatic && !b.automatic && into.binding != b.binding) {
    contradiction(shader, "`" + b.name + "` has binding " + std::to_string(b.binding) + " here and binding " +
                              std::to_string(into.binding) + " in an earlier stage");
  }
  into.readOnly = into.readOnly && b.readOnly;
  into.writeOnly = into.writeOnly && b.writeOnly;
  into.blockBytes = std::max(into.blockBytes, b.blockBytes);
  if (!b.automatic) {  // an explicit number wins
    into.binding = b.binding;
    into.automatic = false;
  }
}

void mergeBindings(const CompiledShader& shader, PipelineInterface& interface) {
  std::set<std::string> own;  // one stage may give a number two names, but not a name two numbers
  for (const ReflectedBinding& b : shader.reflection.bindings) {
    if (b.set == 1) interface.usesSharedSet = true;
    if (b.set > 1)
      contradiction(shader, "`" + b.name + "` is in set " + std::to_string(b.set) + "; only 0 and 1 exist");
    if (b.set != 0) continue;
    if (!own.insert(b.name).second)
      contradiction(shader, "two resources of set 0 have the name `" + b.name + "`");
    if (ReflectedBinding* same = findByName(interface, b)) {
      mergeSame(shader, *same, b);
    } else {
      interface.bindings.push_back(b);
    }
  }
}

// Automatic numbers give way to explicit ones and to each other.
void numberBindings(PipelineInterface& interface) {
  std::set<uint32_t> taken;
  for (const ReflectedBinding& b : interface.bindings) {
    if (!b.automatic) taken.insert(b.binding);
  }
  for (ReflectedBinding& b : interface.bindings) {
    if (!b.automatic) continue;
    if (taken.contains(b.binding)) {
      b.binding = 0;
      while (taken.contains(b.binding)) ++b.binding;
    }
    taken.insert(b.binding);
  }
}

void checkAliases(const CompiledShader& shader, const PipelineInterface& interface) {
  std::map<uint32_t, const ReflectedBinding*> byNumber;
  for (const ReflectedBinding& b : interface.bindings) {
    const auto [it, isNew] = byNumber.emplace(b.binding, &b);
    if (!isNew && (it->second->kind != b.kind || it->second->count != b.count)) {
      contradiction(shader, "`" + b.name + "` and `" + it->second->name + "` both have binding " +
                                std::to_string(b.binding) + " but are different kinds of resource");
    }
  }
}

void mergeConstants(const CompiledShader& shader, PipelineInterface& interface) {
  for (const ReflectedMember& c : shader.reflection.constants) {
    const bool known =
        std::any_of(interface.constants.begin(), interface.constants.end(), [&](const auto& other) {
          return other.name == c.name && other.offset == c.offset && other.bytes == c.bytes &&
                 other.type == c.type;
        });
    if (known) continue;
    for (const ReflectedMember& other : interface.constants) {
      if (other.name == c.name ||
          (c.offset < other.offset + other.bytes && other.offset < c.offset + c.bytes)) {
        contradiction(shader, "push constant `" + c.name + "` at offset " + std::to_string(c.offset) +
                                  " contradicts `" + other.name + "` at offset " +
                                  std::to_string(other.offset) +
                                  " of an earlier stage; declare the same block in all stages");
      }
    }
    interface.constants.push_back(c);
  }
  interface.pushConstantBytes = std::max(interface.pushConstantBytes, shader.reflection.pushConstantBytes);
}

std::vector<uint32_t> withFinalNumbers(const CompiledShader& shader, const PipelineInterface& interface) {
  std::map<uint32_t, uint32_t> numbers;  // from this shader's numbers to the pipeline's
  for (const ReflectedBinding& b : shader.reflection.bindings) {
    if (b.set != 0) continue;
    for (const ReflectedBinding& merged : interface.bindings) {
      if (merged.name == b.name) numbers[b.binding] = merged.binding;
    }
  }
  std::vector<uint32_t> spirv = shader.spirv;
  for (const BindingDecoration& d : bindingDecorations(spirv)) {
    if (const auto it = numbers.find(d.binding); d.set == 0 && it != numbers.end())
      spirv[d.word] = it->second;
  }
  return spirv;
}

}  // namespace

MergedStages mergeStages(const std::vector<std::shared_ptr<const CompiledShader>>& shaders) {
  MergedStages merged;
  PipelineInterface& interface = merged.interface;
  for (const auto& shader : shaders) {
    interface.stages |= shader->reflection.stage;
    std::copy_n(shader->reflection.localSize, 3, interface.localSize);
    mergeBindings(*shader, interface);
    mergeConstants(*shader, interface);
  }
  numberBindings(interface);
  checkAliases(*shaders.back(), interface);
  for (const auto& shader : shaders) merged.spirv.push_back(withFinalNumbers(*shader, interface));
  std::sort(interface.bindings.begin(), interface.bindings.end(),
            [](const ReflectedBinding& a, const ReflectedBinding& b) { return a.binding < b.binding; });
  return merged;
}

}  // namespace fovea::gpu
