// Runs shaders/subdivide alone and compares it with the CPU evaluation of the same tables.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "fovea/error.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/subdivider.h"
#include "framework/session/test_device.h"
#include "tests/gpu/command_helpers.h"
#include "tests/references/octahedral.h"
#include "tests/support/cages.h"

namespace fovea::scene {
namespace {

using fovea::scene::octDecode;
using namespace test;  // NOLINT: cages
using fovea::test::as;
using fovea::test::testDevice;

constexpr VkBufferUsageFlags kUsage =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
const glm::vec4 kUntouched(7, 8, 9, 10);

gpu::Buffer buffer(const char* name, const std::vector<glm::vec4>& data) {
  gpu::Buffer b(testDevice(), {name, data.size() * sizeof(glm::vec4), kUsage});
  gpu::upload(testDevice(), b, std::as_bytes(std::span(data)));
  return b;
}

struct Result {
  std::vector<glm::vec4> positions, attributes;
};

Result apply(const Subdivider& subdivider, const std::vector<glm::vec4>& points, uint32_t vertices,
             const std::vector<Subdivider::Surface>& surfaces) {
  gpu::Buffer in = buffer("points", points);
  gpu::Buffer positions = buffer("positions", std::vector<glm::vec4>(vertices, kUntouched));
  gpu::Buffer attributes = buffer("attributes", std::vector<glm::vec4>(vertices, kUntouched));
  testDevice().runOnce(
      [&](VkCommandBuffer cmd) { subdivider.record(cmd, in, positions, attributes, surfaces); });
  return {as<glm::vec4>(gpu::download(testDevice(), positions)),
          as<glm::vec4>(gpu::download(testDevice(), attributes))};
}

// The vertices of one surface must equal those that the CPU computes.
void expectSurface(const Result& result, const Stencils& stencils, const std::vector<glm::vec3>& points,
                   uint32_t firstVertex, float side) {
  std::vector<glm::vec3> positions(stencils.vertexCount()), normals(stencils.vertexCount());
  stencils.evaluate(points, positions, normals);
  for (uint32_t v = 0; v < stencils.vertexCount(); ++v) {
    const glm::vec4 p = result.positions[firstVertex + v], a = result.attributes[firstVertex + v];
    ASSERT_LT(glm::distance(glm::vec3(p), positions[v]), 1e-5f) << v;
    ASSERT_EQ(p.w, 1.0f);
    ASSERT_LT(glm::distance(octDecode(glm::vec2(a)), side * normals[v]), 1e-5f) << v;
    ASSERT_EQ(glm::vec2(a.z, a.w), glm::vec2(kUntouched.z, kUntouched.w)) << "the texture coordinates stay";
  }
}

// Two tables, three surfaces (one mirrored, two of the same cage in different shapes), at offsets with gaps between.
TEST(Subdivide, EqualsTheCpuEvaluator) {
  for (uint32_t level = 1; level <= 3; ++level) {
    const SubdivisionCage all = everythingCage(level), ball = icosahedronCage(level);
    const std::vector<Stencils> tables = {Stencils(all), Stencils(ball)};
    const Subdivider subdivider(testDevice(), tables);
    const std::vector<std::vector<glm::vec3>> shapes = {jittered(ball, 0.2f, 1).positions,
                                                        jittered(all, 0.1f, 2).positions,
                                                        jittered(all, 0.2f, 3).positions};
    std::vector<Subdivider::Surface> surfaces = {{1, 0, 0, false}, {0, 0, 0, false}, {0, 0, 0, true}};
    std::vector<glm::vec4> points(3, kUntouched);
    uint32_t vertices = 5;
    for (size_t i = 0; i < surfaces.size(); ++i) {
      surfaces[i].firstPoint = uint32_t(points.size());
      surfaces[i].firstVertex = vertices;
      for (const glm::vec3& p : shapes[i]) points.emplace_back(p, 1);
      vertices += tables[surfaces[i].table].vertexCount() + 5;
    }
    const Result result = apply(subdivider, points, vertices, surfaces);
    for (size_t i = 0; i < surfaces.size(); ++i) {
      expectSurface(result, tables[surfaces[i].table], shapes[i], surfaces[i].firstVertex,
                    surfaces[i].mirrored ? -1.0f : 1.0f);
      for (uint32_t gap = 1; gap <= 5; ++gap)
        EXPECT_EQ(result.positions[surfaces[i].firstVertex - gap], kUntouched) << "nothing else is written";
    }
  }
}

TEST(Subdivide, ACollapsedSurfaceHasNormals) {
  const Stencils stencils(cubeCage(2));
  const Subdivider subdivider(testDevice(), std::span(&stencils, 1));
  const std::vector<glm::vec3> points(8, glm::vec3(1, 2, 3));
  const Result result = apply(subdivider, std::vector<glm::vec4>(8, glm::vec4(1, 2, 3, 1)),
                              stencils.vertexCount(), {{0, 0, 0, false}});
  for (uint32_t v = 0; v < stencils.vertexCount(); ++v) {
    EXPECT_LT(glm::distance(glm::vec3(result.positions[v]), points[0]), 1e-5f);
    EXPECT_NEAR(glm::length(octDecode(glm::vec2(result.attributes[v]))), 1, 1e-5);
  }
}

TEST(Subdivide, WithoutSurfacesThereIsNothingToDo) {
  const Subdivider subdivider(testDevice(), {});
  const Result result = apply(subdivider, {glm::vec4(0)}, 1, {});
  EXPECT_EQ(result.positions[0], kUntouched);
}

}  // namespace
}  // namespace fovea::scene
