// Tests the reflection of every kind of binding, and how the bindings of a pipeline's stages are unified.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/error.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/shader/shader.h"
#include "framework/gpu/shader/spirv_bindings.h"

namespace fovea::gpu {
namespace {

std::shared_ptr<const CompiledShader> compile(const std::string& name, const std::string& text) {
  ShaderCompiler compiler({});
  return compiler.compileSource(name, "#version 460\n" + text);
}

const ReflectedBinding& find(const std::vector<ReflectedBinding>& list, const std::string& name) {
  for (const ReflectedBinding& b : list) {
    if (b.name == name) return b;
  }
  throw std::runtime_error("no binding named " + name);
}

constexpr const char* kEverything = R"(
layout(local_size_x = 4, local_size_y = 3, local_size_z = 2) in;
layout(std140) uniform Camera { mat4 matrix; vec4 eye; } camera;
layout(std140) uniform Anonymous { vec4 first; };
layout(std430) readonly buffer Source { vec4 head; vec4 source[]; };
layout(std430) writeonly buffer Target { uint target[]; } result;
layout(std430) buffer Both { uint both[]; };
uniform texture2D plain;
uniform utexture2DArray layered;
uniform texture3D volume;
uniform sampler nearest;
uniform sampler2D combined;
uniform textureBuffer texels;
uniform usamplerBuffer combinedTexels;
layout(rgba16f) writeonly uniform image2D picture;
layout(r32ui) uniform uimage2DArray atomics;
layout(r32f) readonly uniform imageBuffer storedTexels;
uniform texture2D two[2];
uniform texture2D unused;
layout(set = 1, binding = 5) uniform Shared { vec4 shared0; };
layout(push_constant) uniform Constants {
  uint count; int offset; float scale; layout(offset = 16) vec3 colour; uvec2 size; mat4 matrix;
} constants;
void main() {
  vec4 v = camera.eye + first + head + source[constants.count] + texelFetch(plain, ivec2(0), 0) +
           vec4(texelFetch(layered, ivec3(0), 0)) + texture(sampler3D(volume, nearest), vec3(0)) +
           textureLod(combined, vec2(0), 0) + texelFetch(texels, 0) + vec4(texelFetch(combinedTexels, 0)) +
           imageLoad(storedTexels, 0) + texelFetch(two[0], ivec2(0), 0) + texelFetch(two[1], ivec2(0), 0) + shared0;
  result.target[0] = uint(v.x) + imageAtomicAdd(atomics, ivec3(0), 1u);
  both[0] += 1;
  imageStore(picture, ivec2(0), v);
}
)";

TEST(Reflection, EveryKindOfBinding) {
  const auto shader = compile("all.comp", kEverything);
  const Reflection& r = shader->reflection;
  EXPECT_EQ(r.stage, VK_SHADER_STAGE_COMPUTE_BIT);
  EXPECT_THAT(r.localSize, testing::ElementsAre(4, 3, 2));
  const auto kind = [&](const char* name) { return find(r.bindings, name).kind; };
  EXPECT_EQ(kind("camera"), BindingKind::UniformBuffer);     // instance name
  EXPECT_EQ(kind("Anonymous"), BindingKind::UniformBuffer);  // block name
  EXPECT_EQ(kind("Source"), BindingKind::StorageBuffer);
  EXPECT_EQ(kind("result"), BindingKind::StorageBuffer);
  EXPECT_EQ(kind("plain"), BindingKind::SampledImage);
  EXPECT_EQ(kind("layered"), BindingKind::SampledImage);
  EXPECT_EQ(kind("volume"), BindingKind::SampledImage);
  EXPECT_EQ(kind("nearest"), BindingKind::Sampler);
  EXPECT_EQ(kind("combined"), BindingKind::CombinedImageSampler);
  EXPECT_EQ(kind("texels"), BindingKind::UniformTexelBuffer);
  EXPECT_EQ(kind("combinedTexels"), BindingKind::UniformTexelBuffer);
  EXPECT_EQ(kind("picture"), BindingKind::StorageImage);
  EXPECT_EQ(kind("atomics"), BindingKind::StorageImage);
  EXPECT_EQ(kind("storedTexels"), BindingKind::StorageTexelBuffer);

  EXPECT_EQ(find(r.bindings, "camera").blockBytes, 80u);
  EXPECT_EQ(find(r.bindings, "Source").blockBytes, 16u);  // the fixed part
  EXPECT_EQ(find(r.bindings, "two").count, 2u);
  EXPECT_EQ(find(r.bindings, "picture").imageFormat, VK_FORMAT_R16G16B16A16_SFLOAT);
  EXPECT_EQ(find(r.bindings, "atomics").imageFormat, VK_FORMAT_R32_UINT);
  EXPECT_FALSE(find(r.bindings, "plain").imageFormat.has_value());
  EXPECT_TRUE(find(r.bindings, "combinedTexels").integerTexels);
  EXPECT_TRUE(find(r.bindings, "atomics").integerTexels);
  EXPECT_FALSE(find(r.bindings, "texels").integerTexels);
  EXPECT_FALSE(find(r.bindings, "nearest").integerTexels);
  EXPECT_EQ(r.bindings.size(), 17u);  // `unused` is not among them
}

TEST(Reflection, ReadOnlyAndWriteOnly) {
  const auto shader = compile("all.comp", kEverything);
  const auto access = [&](const char* name) {
    const ReflectedBinding& b = find(shader->reflection.bindings, name);
    return std::string(b.readOnly ? "r" : "") + (b.writeOnly ? "w" : "");
  };
  EXPECT_EQ(access("Source"), "r");
  EXPECT_EQ(access("result"), "w");
  EXPECT_EQ(access("Both"), "");
  EXPECT_EQ(access("picture"), "w");
  EXPECT_EQ(access("atomics"), "");
  EXPECT_EQ(access("storedTexels"), "r");
  EXPECT_EQ(access("camera"), "r");
}

TEST(Reflection, PushConstants) {
  const auto shader = compile("all.comp", kEverything);
  using Type = ReflectedMember::Type;
  const std::vector<ReflectedMember>& list = shader->reflection.constants;
  ASSERT_EQ(list.size(), 6u);
  const auto expect = [&](size_t i, const char* name, uint32_t offset, uint32_t bytes, Type type,
                          uint32_t components) {
    EXPECT_EQ(list[i].name, name);
    EXPECT_EQ(list[i].offset, offset) << name;
    EXPECT_EQ(list[i].bytes, bytes) << name;
    EXPECT_EQ(int(list[i].type), int(type)) << name;
    EXPECT_EQ(list[i].components, components) << name;
  };
  expect(0, "count", 0, 4, Type::Uint, 1);
  expect(1, "offset", 4, 4, Type::Int, 1);
  expect(2, "scale", 8, 4, Type::Float, 1);
  expect(3, "colour", 16, 12, Type::Float, 3);
  expect(4, "size", 32, 8, Type::Uint, 2);
  expect(5, "matrix", 48, 64, Type::Float, 16);
  EXPECT_EQ(shader->reflection.pushConstantBytes, 112u);
}

TEST(Reflection, ElementsOfBlocks) {
  const auto shader = compile("elements.comp", R"(
layout(local_size_x = 1) in;
struct Place { vec3 position; float area; };
struct Light { Place place; ivec2 cell; mat3 frame; };
layout(std430) buffer Lights { uint count; Light list[]; } lights;
layout(std430) buffer Colours { vec3 list[]; } colours;
layout(std430) buffer State { Place first; uint rest; } state;
layout(std140) uniform Page { Place page[8]; };
void main() { lights.list[0].place = page[1]; colours.list[0] = state.first.position; }
)");
  using Type = ReflectedMember::Type;
  const auto expect = [&](const char* binding, size_t i, const char* name, uint32_t offset, Type type,
                          uint32_t components) {
    SCOPED_TRACE(std::string(binding) + " " + name);
    const std::vector<ReflectedMember>& list = find(shader->reflection.bindings, binding).element;
    ASSERT_LT(i, list.size());
    EXPECT_EQ(list[i].name, name);
    EXPECT_EQ(list[i].offset, offset);
    EXPECT_EQ(int(list[i].type), int(type));
    EXPECT_EQ(list[i].components, components);
  };
  expect("lights", 0, "place.position", 0, Type::Float, 3);
  expect("lights", 1, "place.area", 12, Type::Float, 1);
  expect("lights", 2, "cell", 16, Type::Int, 2);
  expect("lights", 3, "frame", 32, Type::Other, 1);  // its columns are padded
  expect("colours", 0, "", 0, Type::Float, 3);
  expect("state", 0, "first.position", 0, Type::Float, 3);
  expect("state", 2, "rest", 16, Type::Uint, 1);
  expect("Page", 1, "area", 12, Type::Float, 1);
  EXPECT_EQ(find(shader->reflection.bindings, "lights").elementBytes, 80u);
  EXPECT_EQ(find(shader->reflection.bindings, "colours").elementBytes, 16u);
  EXPECT_EQ(find(shader->reflection.bindings, "Page").elementBytes, 16u);
}

TEST(Reflection, NumbersAreDenseAndWrittenOnesStay) {
  const auto shader = compile("a.comp", R"(
layout(local_size_x = 1) in;
uniform texture2D neverUsed;
uniform texture2D a;
layout(binding = 1) uniform texture2D fixedOne;
uniform texture2D b;
layout(std430) buffer Out { vec4 o; };
layout(set = 1, binding = 0) uniform S { vec4 s; };
void main() { o = texelFetch(a, ivec2(0), 0) + texelFetch(b, ivec2(0), 0) + texelFetch(fixedOne, ivec2(0), 0) + s; }
)");
  std::vector<uint32_t> numbers;
  for (const ReflectedBinding& b : shader->reflection.bindings) {
    if (b.set == 0) numbers.push_back(b.binding);
  }
  EXPECT_THAT(numbers,
              testing::ElementsAre(0, 1, 2, 3));  // used ones first: the unused texture takes none of these
  EXPECT_EQ(find(shader->reflection.bindings, "fixedOne").binding, 1u);
  EXPECT_FALSE(find(shader->reflection.bindings, "fixedOne").automatic);
  EXPECT_TRUE(find(shader->reflection.bindings, "a").automatic);
  EXPECT_EQ(find(shader->reflection.bindings, "S").set, 1u);
  // Reflection agrees with the SPIR-V, and all numbers are different.
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const BindingDecoration& d : bindingDecorations(shader->spirv)) {
    EXPECT_LT(d.binding, 16u);
    EXPECT_TRUE(seen.insert({d.set, d.binding}).second);
  }
  EXPECT_EQ(seen.size(), 6u);
  const Reflection again = reflect(shader->spirv);
  for (const ReflectedBinding& b : shader->reflection.bindings)
    EXPECT_EQ(find(again.bindings, b.name).binding, b.binding) << b.name;
}

TEST(Reflection, RejectsWhatIsNotSpirv) {
  EXPECT_THROW(reflect({}), Error);
  EXPECT_THROW(reflect({0x07230203, 1, 2}), Error);
  EXPECT_THROW(reflect(std::vector<uint32_t>(100, 0xffffffffu)), Error);
}

// ---- Stages of one pipeline -------------------------------------------------------------------------------

// The number of a name in the final SPIR-V of a stage.
uint32_t finalNumber(const MergedStages& merged, size_t stage, const std::string& name) {
  return find(reflect(merged.spirv[stage]).bindings, name).binding;
}

constexpr const char* kVertex = R"(
uniform textureBuffer positions;
uniform textureBuffer normals;
layout(push_constant) uniform C { mat4 transform; uint first; };
void main() { gl_Position = transform * (texelFetch(positions, gl_VertexIndex) + texelFetch(normals, int(first))); }
)";

TEST(MergeStages, SameNameSameNumberAndNoCollisions) {
  const auto vertex = compile("v.vert", kVertex);
  const auto fragment = compile("f.frag", R"(
uniform texture2D albedo;
uniform textureBuffer normals;
layout(push_constant) uniform C { mat4 transform; uint first; };
layout(location = 0) out vec4 colour;
void main() { colour = texelFetch(albedo, ivec2(0), 0) + texelFetch(normals, int(first)); }
)");
  const MergedStages merged = mergeStages({vertex, fragment});
  ASSERT_EQ(merged.interface.bindings.size(), 3u);
  EXPECT_EQ(merged.interface.stages,
            VkShaderStageFlags(VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT));
  std::set<uint32_t> numbers;
  for (const ReflectedBinding& b : merged.interface.bindings) numbers.insert(b.binding);
  EXPECT_EQ(numbers.size(), 3u);
  EXPECT_EQ(finalNumber(merged, 0, "normals"), finalNumber(merged, 1, "normals"));
  for (const char* name : {"positions", "normals"})
    EXPECT_EQ(finalNumber(merged, 0, name), find(merged.interface.bindings, name).binding);
  EXPECT_EQ(finalNumber(merged, 1, "albedo"), find(merged.interface.bindings, "albedo").binding);
  EXPECT_EQ(merged.interface.constants.size(), 2u);  // the block is the same in both
  EXPECT_EQ(merged.interface.pushConstantBytes, 68u);
}

TEST(MergeStages, WrittenNumbersWin) {
  const auto vertex = compile("v.vert", kVertex);  // positions 0, normals 1, both by the compiler
  const auto fragment = compile("f.frag", R"(
layout(binding = 0) uniform texture2D albedo;
layout(binding = 7) uniform textureBuffer normals;
layout(location = 0) out vec4 colour;
void main() { colour = texelFetch(albedo, ivec2(0), 0) + texelFetch(normals, 0); }
)");
  const MergedStages merged = mergeStages({vertex, fragment});
  EXPECT_EQ(find(merged.interface.bindings, "albedo").binding, 0u);
  EXPECT_EQ(find(merged.interface.bindings, "normals").binding, 7u);
  EXPECT_EQ(finalNumber(merged, 0, "normals"), 7u);
  EXPECT_EQ(finalNumber(merged, 1, "normals"), 7u);
  EXPECT_EQ(finalNumber(merged, 0, "positions"), find(merged.interface.bindings, "positions").binding);
  EXPECT_NE(finalNumber(merged, 0, "positions"), 0u);
}

void expectContradiction(const std::string& vertex, const std::string& fragment, const std::string& about) {
  try {
    mergeStages({compile("v.vert", vertex), compile("f.frag", fragment)});
    ADD_FAILURE() << "no contradiction about " << about;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_THAT(e.what(), testing::HasSubstr(about));
    EXPECT_THAT(e.what(), testing::HasSubstr("f.frag"));
  }
}

TEST(MergeStages, ContradictionsAreNamed) {
  const std::string outputs = "layout(location = 0) out vec4 colour;\n";
  const std::string vertex =
      "layout(binding = 1) uniform textureBuffer a;\nvoid main() { gl_Position = texelFetch(a, 0); }\n";
  expectContradiction(
      vertex, outputs + "uniform texture2D a;\nvoid main() { colour = texelFetch(a, ivec2(0), 0); }\n",
      "`a` is another kind");
  expectContradiction(
      vertex,
      outputs + "layout(binding = 2) uniform textureBuffer a;\nvoid main() { colour = texelFetch(a, 0); }\n",
      "`a` has binding 2");
  expectContradiction(
      vertex,
      outputs +
          "layout(binding = 1) uniform texture2D b;\nvoid main() { colour = texelFetch(b, ivec2(0), 0); }\n",
      "both have binding 1");
  expectContradiction(vertex,
                      outputs +
                          "layout(set = 2, binding = 1) uniform texture2D b;\nvoid main() { colour = "
                          "texelFetch(b, ivec2(0), 0); }\n",
                      "set 2");
  expectContradiction("layout(push_constant) uniform C { vec4 p; };\nvoid main() { gl_Position = p; }\n",
                      outputs + "layout(push_constant) uniform C { vec4 q; };\nvoid main() { colour = q; }\n",
                      "push constant `q`");
}

TEST(MergeStages, UsesTheSharedSet) {
  const auto with =
      compile("a.comp",
              "layout(local_size_x = 1) in;\nlayout(set = 1, binding = 0) uniform S { vec4 s; };\n"
              "buffer O { vec4 o; };\nvoid main() { o = s; }\n");
  const auto without =
      compile("b.comp",
              "layout(local_size_x = 1) in;\nlayout(set = 1, binding = 0) uniform S { vec4 s; };\n"
              "buffer O { vec4 o; };\nvoid main() { o = vec4(0); }\n");
  EXPECT_TRUE(mergeStages({with}).interface.usesSharedSet);
  EXPECT_FALSE(mergeStages({without}).interface.usesSharedSet);
  EXPECT_EQ(mergeStages({with}).interface.bindings.size(), 1u);
}

}  // namespace
}  // namespace fovea::gpu
