#include "framework/gpu/shader/operations.h"

#include <GLSL.std.450.h>
#include <cstring>
#include <map>
#include <spirv.hpp>

#include "framework/gpu/shader/spirv_instructions.h"

namespace fovea::gpu {
namespace {

using Words = std::span<const uint32_t>;

// Follows a module from its types on and says how many operations each instruction is.
class OperationCounter {
 public:
  uint32_t operations(uint32_t op, Words words);

 private:
  struct Shape {
    uint32_t components = 1, columns = 1;
  };
  void note(uint32_t op, Words words);
  Shape shapeOf(uint32_t id) const {
    const auto type = typeOf_.find(id);
    return type == typeOf_.end() ? Shape() : shapes_.at(type->second);
  }
  uint32_t extended(Words words) const;

  std::map<uint32_t, Shape> shapes_;     // of types
  std::map<uint32_t, uint32_t> typeOf_;  // of results
  uint32_t functions_ = 0;               // the set GLSL.std.450
};

void OperationCounter::note(uint32_t op, Words words) {
  switch (op) {
    case spv::OpExtInstImport:
      if (std::strcmp(reinterpret_cast<const char*>(&words[2]), "GLSL.std.450") == 0) functions_ = words[1];
      return;
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
      shapes_[words[1]] = {};
      return;
    case spv::OpTypeVector:
      shapes_[words[1]] = {words[3], 1};
      return;
    case spv::OpTypeMatrix:
      shapes_[words[1]] = {shapes_[words[2]].components * words[3], words[3]};
      return;
    default:
      // No other id stands there than that of the type of a result.
      if (words.size() > 2 && shapes_.contains(words[1])) typeOf_[words[2]] = words[1];
  }
}

uint32_t OperationCounter::operations(uint32_t op, Words words) {
  note(op, words);
  if (words.size() < 4) return 0;
  const uint32_t n = shapeOf(words[2]).components;
  switch (op) {
    case spv::OpFAdd:
    case spv::OpFSub:
    case spv::OpFMul:
    case spv::OpFDiv:
    case spv::OpFRem:
    case spv::OpFMod:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
    case spv::OpOuterProduct:
    case spv::OpDPdx:
    case spv::OpDPdy:
    case spv::OpFwidth:
      return n;
    case spv::OpDot:
    case spv::OpVectorTimesMatrix:
      return n * (2 * shapeOf(words[3]).components - 1);
    case spv::OpMatrixTimesVector:
      return n * (2 * shapeOf(words[4]).components - 1);
    case spv::OpMatrixTimesMatrix:
      return n * (2 * shapeOf(words[3]).columns - 1);
    case spv::OpExtInst:
      return words[3] == functions_ ? extended(words) : 0;
    default:
      return 0;
  }
}

// Of a function of GLSL.std.450.
uint32_t OperationCounter::extended(Words words) const {
  const uint32_t n = shapeOf(words[2]).components;                         // of the result
  const uint32_t m = words.size() > 5 ? shapeOf(words[5]).components : 1;  // of the first argument
  switch (words[4]) {
    case GLSLstd450Round:
    case GLSLstd450RoundEven:
    case GLSLstd450Trunc:
    case GLSLstd450Floor:
    case GLSLstd450Ceil:
    case GLSLstd450Fract:
    case GLSLstd450Radians:
    case GLSLstd450Degrees:
    case GLSLstd450Sin:
    case GLSLstd450Cos:
    case GLSLstd450Exp2:
    case GLSLstd450Log2:
    case GLSLstd450Sqrt:
    case GLSLstd450InverseSqrt:
    case GLSLstd450FMin:
    case GLSLstd450FMax:
    case GLSLstd450NMin:
    case GLSLstd450NMax:
    case GLSLstd450Step:
      return n;
    case GLSLstd450Exp:
    case GLSLstd450Log:
    case GLSLstd450Fma:
      return 2 * n;
    case GLSLstd450Tan:
    case GLSLstd450Pow:
    case GLSLstd450FMix:
    case GLSLstd450Normalize:
      return 3 * n;
    case GLSLstd450Asin:  // a polynomial
    case GLSLstd450Acos:
    case GLSLstd450Atan:
    case GLSLstd450Atan2:
    case GLSLstd450Sinh:
    case GLSLstd450Cosh:
    case GLSLstd450Tanh:
    case GLSLstd450Reflect:
    case GLSLstd450Refract:
      return 4 * n;
    case GLSLstd450SmoothStep:
      return 6 * n;
    case GLSLstd450Length:
      return 2 * m;
    case GLSLstd450Distance:
      return 3 * m;
    case GLSLstd450FaceForward:
      return 2 * n - 1;
    case GLSLstd450Cross:
      return 9;
    default:
      return 0;
  }
}

// Instructions that have to come first in a block.
bool leadsBlock(uint32_t op) {
  return op == spv::OpLabel || op == spv::OpPhi || op == spv::OpVariable || op == spv::OpLine ||
         op == spv::OpNoLine;
}

}  // namespace

std::vector<InstructionBlock> instructionBlocks(const std::vector<uint32_t>& spirv) {
  std::vector<InstructionBlock> blocks;
  OperationCounter counter;
  bool leading = false;
  eachInstruction(spirv, [&](uint32_t op, Words words, size_t at) {
    const uint32_t operations = counter.operations(op, words);
    if (op == spv::OpLabel) blocks.emplace_back();
    if (blocks.empty()) return;
    blocks.back().operations += operations;
    leading = op == spv::OpLabel || (leading && leadsBlock(op));
    if (leading) blocks.back().begin = at + words.size();
  });
  return blocks;
}

}  // namespace fovea::gpu
