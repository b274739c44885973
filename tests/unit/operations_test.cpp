// Tests how many floating-point operations are read off shaders, against numbers counted by hand.
#include "framework/gpu/shader/operations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace fovea {
namespace {

std::shared_ptr<const gpu::CompiledShader> compile(const std::string& body) {
  gpu::ShaderCompiler compiler({});
  return compiler.compileSource("tiny.comp", R"(
layout(local_size_x = 1) in;
layout(std430) buffer Data { vec4 data[]; };
void main() {
  vec4 v = data[0];
  mat3 m = mat3(v.xyz, v.yzx, v.zxy);
)" + body + "}\n");
}

// Of the blocks that have any, in order.
std::vector<uint32_t> operations(const std::string& body) {
  std::vector<uint32_t> list;
  for (const gpu::InstructionBlock& block : gpu::instructionBlocks(compile(body)->spirv))
    if (block.operations > 0) list.push_back(block.operations);
  return list;
}

using testing::ElementsAre;

TEST(Operations, VectorsCountTheirComponents) {
  EXPECT_THAT(operations("data[1] = v * v + v;"), ElementsAre(8));
  EXPECT_THAT(operations("data[1].x = v.x / v.y - v.z;"), ElementsAre(2));
  EXPECT_THAT(operations("data[1] = v * v.x;"), ElementsAre(4));
  EXPECT_THAT(operations("data[1] = fma(v, v, v);"), ElementsAre(8));
}

TEST(Operations, ProductsOfVectorsAndMatrices) {
  EXPECT_THAT(operations("data[1].x = dot(v, v);"), ElementsAre(7));
  EXPECT_THAT(operations("data[1].xyz = m * v.xyz;"), ElementsAre(15));
  EXPECT_THAT(operations("data[1].xyz = v.xyz * m;"), ElementsAre(15));
  EXPECT_THAT(operations("data[1].xyz = (m * m)[0];"), ElementsAre(45));
  EXPECT_THAT(operations("data[1].xyz = cross(v.xyz, v.zxy);"), ElementsAre(9));
}

TEST(Operations, FunctionsHaveTheirWeights) {
  EXPECT_THAT(operations("data[1] = sqrt(v);"), ElementsAre(4));
  EXPECT_THAT(operations("data[1].xy = pow(v.xy, v.zw);"), ElementsAre(6));
  EXPECT_THAT(operations("data[1].xyz = normalize(v.xyz);"), ElementsAre(9));
  EXPECT_THAT(operations("data[1].x = length(v.xyz);"), ElementsAre(6));
  EXPECT_THAT(operations("data[1] = mix(v, v.wzyx, 0.5);"), ElementsAre(12));
}

TEST(Operations, SomeAreFree) {
  EXPECT_TRUE(operations("data[1] = clamp(-abs(v), 0.0, 1.0);").empty());
  EXPECT_TRUE(operations("data[1].x = float(int(v.x) * 3 + 1);").empty());
  EXPECT_TRUE(operations("data[1].x = v.x > v.y ? 1.0 : 2.0;").empty());
}

TEST(Operations, BranchesAndLoopsAreBlocksOfTheirOwn) {
  EXPECT_THAT(operations("if (v.x > 0.0) data[1] = v * v; else data[1].x = v.x + v.y;"), ElementsAre(4, 1));
  EXPECT_THAT(operations("for (int i = 0; i < 9; ++i) v = v * v + 1.0; data[1] = v + 2.0;"),
              ElementsAre(8, 4));
}

TEST(Operations, ACountingShaderHasOneMoreBindingOfItsOwn) {
  const auto shader = compile("data[1] = v * v;"), counting = gpu::countingShader(*shader);
  EXPECT_NE(counting->hash, shader->hash);
  const std::vector<gpu::ReflectedBinding>& bindings = counting->reflection.bindings;
  ASSERT_EQ(bindings.size(), shader->reflection.bindings.size() + 1);
  EXPECT_EQ(bindings.back().name, gpu::kOperationsBinding);
  std::set<uint32_t> numbers;
  for (const gpu::ReflectedBinding& b : bindings) numbers.insert(b.binding);
  EXPECT_EQ(numbers.size(), bindings.size());
  EXPECT_EQ(gpu::reflect(counting->spirv).bindings.size(), bindings.size());
}

}  // namespace
}  // namespace fovea
