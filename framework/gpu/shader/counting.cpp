// Makes shaders that count the floating-point operations that they execute.
#include <algorithm>
#include <map>
#include <span>
#include <spirv-tools/optimizer.hpp>
#include <spirv.hpp>
#include <utility>

#include "framework/gpu/shader/operations.h"
#include "framework/gpu/shader/spirv_bindings.h"
#include "framework/gpu/shader/spirv_instructions.h"

namespace fovea::gpu {
namespace {

using Module = std::vector<uint32_t>;

// The module without unused code and with common expressions computed once, or unchanged if the optimiser fails.
Module optimized(const Module& spirv) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.RegisterPerformancePasses();
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  Module result;
  return optimizer.Run(spirv.data(), spirv.size(), &result, options) ? result : spirv;
}

bool isType(uint32_t op) { return op >= spv::OpTypeVoid && op <= spv::OpTypeForwardPointer; }

class Instrumentation {
 public:
  Instrumentation(const Module& in, uint32_t binding)
      : in_(in), next_(in[kSpirvIdBound]), binding_(binding) {}
  Module run();

 private:
  void add(spv::Op op, std::initializer_list<uint32_t> words) {
    out_.push_back(uint32_t(words.size() + 1) << 16 | uint32_t(op));
    out_.insert(out_.end(), words);
  }
  void scan();
  void decorate();
  void declare();
  void count(uint32_t operations);
  void report();

  const Module& in_;
  Module out_;
  uint32_t next_;  // the next free id
  uint32_t binding_;
  uint32_t entry_ = 0;            // the function that the stage starts with
  uint32_t uint_ = 0, bool_ = 0;  // types that may exist only once
  bool declaresUint_ = true, declaresBool_ = true;
  uint32_t block_ = 0, buffer_ = 0, sum_ = 0, word_ = 0, zero_ = 0, one_ = 0;
  std::map<uint32_t, uint32_t> constants_;  // by value
};

void Instrumentation::scan() {
  eachInstruction(in_, [&](uint32_t op, std::span<const uint32_t> words, size_t) {
    if (op == spv::OpEntryPoint) entry_ = words[2];
    if (op == spv::OpTypeInt && words[2] == 32 && words[3] == 0) uint_ = words[1];
    if (op == spv::OpTypeBool) bool_ = words[1];
  });
  declaresUint_ = uint_ == 0, declaresBool_ = bool_ == 0;
  if (declaresUint_) uint_ = next_++;
  if (declaresBool_) bool_ = next_++;
  for (uint32_t* id : {&block_, &buffer_, &sum_, &word_}) *id = next_++;
  for (const InstructionBlock& block : instructionBlocks(in_)) constants_.emplace(block.operations, 0);
  constants_.emplace(0, 0), constants_.emplace(1, 0);
  for (auto& [value, id] : constants_) id = next_++;
  zero_ = constants_[0], one_ = constants_[1];
}

void Instrumentation::decorate() {
  add(spv::OpDecorate, {block_, spv::DecorationBlock});
  add(spv::OpMemberDecorate, {block_, 0, spv::DecorationOffset, 0});
  add(spv::OpMemberDecorate, {block_, 1, spv::DecorationOffset, 4});
  add(spv::OpDecorate, {buffer_, spv::DecorationDescriptorSet, 0});
  add(spv::OpDecorate, {buffer_, spv::DecorationBinding, binding_});
}

void Instrumentation::declare() {
  const uint32_t blockPointer = next_++, sumPointer = next_++;
  if (declaresUint_) add(spv::OpTypeInt, {uint_, 32, 0});
  if (declaresBool_) add(spv::OpTypeBool, {bool_});
  for (const auto& [value, id] : constants_) add(spv::OpConstant, {uint_, id, value});
  add(spv::OpTypeStruct, {block_, uint_, uint_});
  add(spv::OpTypePointer, {blockPointer, spv::StorageClassStorageBuffer, block_});
  add(spv::OpTypePointer, {word_, spv::StorageClassStorageBuffer, uint_});
  add(spv::OpTypePointer, {sumPointer, spv::StorageClassPrivate, uint_});
  add(spv::OpVariable, {blockPointer, buffer_, spv::StorageClassStorageBuffer});
  add(spv::OpVariable, {sumPointer, sum_, spv::StorageClassPrivate, zero_});
}

// Adds to the sum of the invocation.
void Instrumentation::count(uint32_t operations) {
  const uint32_t before = next_++, after = next_++;
  add(spv::OpLoad, {uint_, before, sum_});
  add(spv::OpIAdd, {uint_, after, before, constants_[operations]});
  add(spv::OpStore, {sum_, after});
}

// Adds the sum to the buffer, and 1 to its high word if the low one overflows.
void Instrumentation::report() {
  const uint32_t sum = next_++, low = next_++, before = next_++, after = next_++, overflows = next_++,
                 carry = next_++, high = next_++;
  add(spv::OpLoad, {uint_, sum, sum_});
  add(spv::OpAccessChain, {word_, low, buffer_, zero_});
  add(spv::OpAtomicIAdd, {uint_, before, low, one_, zero_, sum});  // scope 1 is the device
  add(spv::OpIAdd, {uint_, after, before, sum});
  add(spv::OpULessThan, {bool_, overflows, after, before});
  add(spv::OpSelect, {uint_, carry, overflows, one_, zero_});
  add(spv::OpAccessChain, {word_, high, buffer_, one_});
  add(spv::OpAtomicIAdd, {uint_, next_++, high, one_, zero_, carry});
}

Module Instrumentation::run() {
  scan();
  const std::vector<InstructionBlock> blocks = instructionBlocks(in_);
  auto block = blocks.begin();
  bool decorated = false, declared = false;
  uint32_t function = 0;
  out_.assign(in_.begin(), in_.begin() + kSpirvHeaderWords);
  eachInstruction(in_, [&](uint32_t op, std::span<const uint32_t> words, size_t at) {
    if (isType(op) && !std::exchange(decorated, true)) decorate();
    if (op == spv::OpFunction && !std::exchange(declared, true)) declare();
    if (op == spv::OpFunction) function = words[2];
    for (; block != blocks.end() && block->begin == at; ++block)
      if (block->operations > 0) count(block->operations);
    if ((op == spv::OpReturn && function == entry_) || op == spv::OpKill || op == spv::OpTerminateInvocation)
      report();
    const size_t copy = out_.size();
    out_.insert(out_.end(), words.begin(), words.end());
    if (op != spv::OpEntryPoint) return;
    out_.insert(out_.end(), {buffer_, sum_});  // all global variables that the stage uses
    out_[copy] += 2u << 16;
  });
  out_[kSpirvIdBound] = next_;
  return std::move(out_);
}

}  // namespace

std::shared_ptr<const CompiledShader> countingShader(const CompiledShader& shader) {
  auto counting = std::make_shared<CompiledShader>(shader);
  ReflectedBinding operations;
  operations.name = kOperationsBinding;
  operations.kind = BindingKind::StorageBuffer;
  operations.blockBytes = operations.elementBytes = kOperationsBytes;
  operations.automatic = true;
  for (const BindingDecoration& d : bindingDecorations(shader.spirv))
    if (d.set == 0) operations.binding = std::max(operations.binding, d.binding + 1);
  counting->spirv = Instrumentation(optimized(shader.spirv), operations.binding).run();
  counting->reflection.bindings.push_back(std::move(operations));
  counting->hash = ~shader.hash;
  return counting;
}

}  // namespace fovea::gpu
