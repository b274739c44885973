// Compares shaders/scene/scene.glsl with plain references: textures, materials, lights and geometry.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/scene.h"
#include "framework/session/test_device.h"
#include "passes/path-trace/lights.h"
#include "tests/gpu/scene_queries.h"
#include "tests/references/passage.h"

namespace fovea::scene {
namespace {

using test::evaluate;
using test::testDevice;

float random(uint32_t stream, uint32_t index) { return uniformFloat(hashCombine(stream, index)); }

Texture noiseTexture(uint32_t width, uint32_t height, bool srgb, uint32_t seed) {
  Texture t{"noise", width, height, srgb, std::vector<uint8_t>(size_t(width) * height * 4)};
  for (uint32_t i = 0; i < t.rgba.size(); ++i) t.rgba[i] = uint8_t(hashCombine(seed, i));
  return t;
}

// Textures of every kind of size, with one material for every wrap mode of each.
Scene texturedScene() {
  Scene scene;
  const glm::uvec2 sizes[] = {{1, 1}, {2, 1}, {3, 5}, {64, 64}, {200, 17}, {1, 300}, {256, 128}, {33, 255}};
  for (uint32_t i = 0; i < 16; ++i)
    scene.textures.push_back(noiseTexture(sizes[i % 8].x, sizes[i % 8].y, i % 3 != 0, i));
  scene.textures.push_back(noiseTexture(8, 8, true, 99));  // used by nothing
  for (uint32_t i = 0; i < 16 * 9; ++i) {
    Material m;
    const glm::mat3x2 transform(1 + random(1, i), random(2, i) - 0.5f, random(3, i) - 0.5f, -1 - random(4, i),
                                4 * random(5, i), -3 * random(6, i));
    m.baseColor = {random(7, i), random(8, i), random(9, i), random(10, i)};
    m.metallic = i % 4 == 0 ? random(11, i) : 0;
    m.baseColorTexture = {i / 9, Wrap(i % 3), Wrap(i / 3 % 3),
                          i % 2 ? transform : glm::mat3x2(1, 0, 0, 1, 0, 0)};
    if (i % 5 == 0) m.emission = {3 * random(12, i), 1, 0};
    if (i % 10 == 0) m.emissionTexture = {(i / 9 + 5) % 16, Wrap(i / 3 % 3), Wrap(i % 3), transform};
    m.masked = i % 3 == 0;
    m.alphaCutoff = random(13, i);
    m.doubleSided = i % 2 == 0;
    scene.materials.push_back(m);
  }
  scene.materials.emplace_back();  // without any texture
  return scene;
}

// A coordinate over n texels has steps of n 2^-23, which the slope between two texels turns into an error
// of the result.
double coordinateError(const Scene& scene, const TextureUse& use, glm::vec2 uv) {
  if (!use) return 0;
  const Texture& t = scene.textures[use.texture];
  const glm::vec2 p = use.transform * glm::vec3(uv, 1);
  return 4 * 0x1p-23 * double(std::abs(p.x) * t.width + std::abs(p.y) * t.height + 1);
}

TEST(SceneGlsl, MaterialsAndTextures) {
  const Scene scene = texturedScene();
  const Geometry geometry;
  GpuScene gpu(testDevice(), scene, geometry, 2);
  Frame frame;
  std::vector<glm::vec4> queries;
  for (uint32_t m = 0; m < scene.materials.size(); ++m)
    for (uint32_t i = 0; i < 64; ++i) {
      const uint32_t k = m * 64 + i;
      const float reach = i < 48 ? 3 : 300;
      glm::vec2 uv(reach * (2 * random(20, k) - 1), reach * (2 * random(21, k) - 1));
      if (i % 8 == 0) uv = glm::round(uv * 4.0f) / 4.0f;  // on texel edges and corners
      queries.emplace_back(float(m), uv, 0);
    }
  queries.emplace_back(0, std::nanf(""), 1e30f, 0);
  const auto results = evaluate(gpu, frame, queries, R"(
    uint m = uint(q.x);
    SurfacePoint s = surfaceAt(m, q.yz);
    Material material = loadMaterial(m);
    r[0] = vec4(s.reflectance, materialReflectance(m, q.yz).a);
    r[1] = vec4(s.emission, stops(m, q.yz, 1.0, 1.0, kEitherWay) ? 1.0 : 0.0);
    r[2] = vec4(material.doubleSided ? 1.0 : 0.0, material.alphaCutoff, material.alpha, material.baseColor.g);
  )");
  for (size_t i = 0; i + 1 < queries.size(); ++i) {
    const Material& m = scene.materials[size_t(queries[i].x)];
    const glm::vec2 uv(queries[i].y, queries[i].z);
    const double tolerance =
        1e-5 + coordinateError(scene, m.baseColorTexture, uv) + coordinateError(scene, m.emissionTexture, uv);
    const glm::vec4 color = reflectance(scene, m, uv);
    const glm::vec3 light = emission(scene, m, uv);
    for (int c = 0; c < 4; ++c) {
      ASSERT_NEAR(results[3 * i][c], color[c], tolerance)
          << "material " << queries[i].x << " uv " << uv.x << " " << uv.y;
    }
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(results[3 * i + 1][c], light[c], 3 * tolerance);
    if (!m.masked || std::abs(color.a - m.alphaCutoff) > tolerance) {
      EXPECT_EQ(results[3 * i + 1].w, !m.masked || color.a >= m.alphaCutoff ? 1 : 0);
    }
    EXPECT_EQ(results[3 * i + 2].x, m.doubleSided ? 1 : 0);
    EXPECT_FLOAT_EQ(results[3 * i + 2].y, m.masked ? m.alphaCutoff : 0);
    EXPECT_FLOAT_EQ(results[3 * i + 2].z, m.baseColor.a);
    EXPECT_FLOAT_EQ(results[3 * i + 2].w, m.baseColor.g * (1 - m.metallic));
  }
  for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(results[results.size() - 3][c]));
}

// Away from the edges of texels, where rounding decides.
TEST(SceneGlsl, NearestTexelsAndAlphaOfVertices) {
  Scene scene = texturedScene();
  for (Material& m : scene.materials) {
    m.baseColorTexture.nearest = true;
    m.baseColorTexture.transform = {1, 0, 0, 1, 0, 0};
    m.masked = true;
  }
  GpuScene gpu(testDevice(), scene, {}, 2);
  std::vector<glm::vec4> queries;
  for (uint32_t m = 0; m + 1 < scene.materials.size(); ++m)
    for (uint32_t i = 0; i < 32; ++i) {
      const uint32_t k = m * 32 + i;
      const Texture& t = scene.textures[scene.materials[m].baseColorTexture.texture];
      const glm::vec2 texel =
          glm::floor(glm::vec2(t.width, t.height) * (4.0f * glm::vec2(random(40, k), random(41, k)) - 2.0f));
      const glm::vec2 inside(0.1f + 0.8f * random(42, k), 0.1f + 0.8f * random(43, k));
      queries.emplace_back(float(m), (texel + inside) / glm::vec2(t.width, t.height), random(44, k));
    }
  const auto results = evaluate(gpu, Frame{}, queries, R"(
    uint m = uint(q.x);
    r[0] = materialReflectance(m, q.yz);
    r[1] = vec4(stops(m, q.yz, q.w, 1.0, kEitherWay) ? 1.0 : 0.0);
  )");
  uint32_t solid = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Material& m = scene.materials[size_t(queries[i].x)];
    const glm::vec4 color = reflectance(scene, m, {queries[i].y, queries[i].z});
    for (int c = 0; c < 4; ++c) ASSERT_NEAR(results[3 * i][c], color[c], 1e-5) << i;
    const float alpha = color.a * queries[i].w;
    if (std::abs(alpha - m.alphaCutoff) > 1e-5f) {
      ASSERT_EQ(results[3 * i + 1].x, float(alpha >= m.alphaCutoff)) << i;
    }
    solid += alpha >= m.alphaCutoff;
  }
  EXPECT_GT(solid, queries.size() / 20);
  EXPECT_LT(solid, queries.size() / 2);
}

// Even where the device's own are as far off as Vulkan allows.
TEST(SceneGlsl, QuotientsAndRootsAreThoseOfTheCpu) {
  GpuScene gpu(testDevice(), Scene{}, {}, 2);
  std::vector<glm::vec4> queries;
  for (uint32_t i = 0; i < 20000; ++i) {
    const float scale = std::exp2(std::floor(40 * random(1, i)) - 20);
    queries.emplace_back(random(2, i) - 0.5f, scale * (random(3, i) - 0.5f), scale * random(4, i), 0);
  }
  queries.emplace_back(0, 3, 0, 0);
  for (const int off : {-2, 0, 2}) {
    const auto results =
        evaluate(gpu, Frame{}, queries, R"(
    r[0] = vec4(quotient(q.x, q.y), quotient(1.0, q.y), root(q.z), quotient(1.0, 0.0 * q.z));
  )",
                 "float offBy(float x) { return x == 0.0 ? x : intBitsToFloat(floatBitsToInt(x) + " +
                     std::to_string(off) +
                     "); }\n#define DEVICE_QUOTIENT(a, b) offBy((a) / (b))\n"
                     "#define DEVICE_ROOT(x) offBy(sqrt(x))\n#include \"device/exact.glsl\"");
    for (size_t i = 0; i < queries.size(); ++i) {
      const glm::vec4 q = queries[i], r = results[3 * i];
      ASSERT_EQ(r.x, q.x / q.y) << q.x << " / " << q.y << " off by " << off;
      ASSERT_EQ(r.y, 1 / q.y) << "1 / " << q.y << " off by " << off;
      ASSERT_EQ(r.z, std::sqrt(q.z)) << "root of " << q.z << " off by " << off;
      if (off == 0) {
        ASSERT_EQ(r.w, std::numeric_limits<float>::infinity());
      }
    }
  }
}

TEST(SceneGlsl, Lights) {
  Scene scene;
  scene.materials.emplace_back();
  Frame frame;
  for (uint32_t i = 0; i < kMaxLights; ++i) {
    Light light;
    light.type = LightType(i % 3);
    light.color = {random(1, i), random(2, i), 1};
    light.intensity = 10 * random(3, i);
    light.range = i % 4 == 0 ? 8 : 0;
    light.innerConeAngle = 0.5f * random(4, i);
    light.outerConeAngle = light.innerConeAngle + (i % 7 == 0 ? 0 : random(5, i));
    light.position = glm::vec3(random(6, i), random(7, i), random(8, i)) * 10.0f - 5.0f;
    light.direction = glm::normalize(glm::vec3(random(9, i), random(10, i), random(11, i)) - 0.5f);
    frame.lights.push_back(light);
  }
  GpuScene gpu(testDevice(), scene, {}, 2);
  std::vector<glm::vec4> queries;
  for (uint32_t k = 0; k < kMaxLights * 32; ++k)
    queries.emplace_back(glm::vec3(random(20, k), random(21, k), random(22, k)) * 12.0f - 6.0f,
                         float(k % kMaxLights));
  const auto results = evaluate(gpu, frame, queries, R"(
    LightRecord light = lights[uint(q.w)];
    LightSample s = sampleLight(light, q.xyz);
    r[0] = vec4(s.irradiance, s.distance);
    r[1] = vec4(s.direction, float(light.firstShadowLayer));
    r[2] = vec4(frame.lightCount);
  )");
  std::vector<uint32_t> firstLayer(kMaxLights);
  for (uint32_t i = 1; i < kMaxLights; ++i)
    firstLayer[i] = firstLayer[i - 1] + shadowLayers(frame.lights[i - 1]);
  int lit = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Light& light = frame.lights[i % kMaxLights];
    const path_trace::IncidentLight s = path_trace::incidentLight(light, glm::vec3(queries[i]));
    lit += s.irradiance.z > 0;
    // A hard-edged cone (equal angles) has a slope of 1e4 over its cosine.
    const double slack = spotCone(light).scale() > 1000 && light.type == LightType::Spot ? 2e-2 : 1e-4;
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(results[3 * i][c], s.irradiance[c], slack * (1 + s.irradiance[c]))
          << "light " << i % kMaxLights;
      ASSERT_NEAR(results[3 * i + 1][c], s.direction[c], 1e-5);
    }
    ASSERT_NEAR(results[3 * i][3] / std::min(s.distance, 1e30f), 1, 1e-5);
    ASSERT_EQ(results[3 * i + 1].w, float(firstLayer[i % kMaxLights]));
    ASSERT_EQ(results[3 * i + 2].x, float(kMaxLights));
  }
  EXPECT_GT(lit, int(queries.size() / 2));  // the comparison is not one of zeros
}

// Two triangles of two objects.
Geometry smallGeometry() {
  Geometry g;
  for (uint32_t i = 0; i < 6; ++i) {
    g.positions.emplace_back(random(1, i), 10 * random(2, i), -random(3, i));
    g.normals.push_back(glm::normalize(glm::vec3(random(4, i), random(5, i), random(6, i)) - 0.5f));
    g.uvs.emplace_back(random(7, i), -7 * random(8, i));
  }
  g.normals[0] = {0, 0, -1};
  g.normals[1] = {0, -1, 0};
  g.triangles = {{{0, 1, 2}, 3u}, {{5, 4, 3}, 7u | 1u << 16}};
  g.staticTriangles = 1;
  g.boundsMin = {0, 0, -1};
  g.boundsMax = {1, 10, 0};
  return g;
}

TEST(SceneGlsl, GeometryFrameAndViews) {
  Scene scene;
  scene.materials.resize(8);
  scene.environment = {0.5f, 0.25f, 2};
  const Geometry geometry = smallGeometry();
  GpuScene gpu(testDevice(), scene, geometry, 2);
  EXPECT_EQ(gpu.triangleCount(), 2u);
  EXPECT_EQ(gpu.vertexCount(), 6u);
  Camera camera;
  camera.position = {1, 2, 3};
  Frame frame;
  frame.index = 11;
  frame.seed = 77;
  frame.time = 0.25;
  frame.exposure = 1.5f;
  for (uint32_t i = 0; i < kMaxViews; ++i) {
    frame.views.push_back(makeView(camera, {64 + i, 32}, geometry, {0.25f, 0.75f}));
    camera.position.x += 1;
  }
  std::vector<glm::vec4> queries;
  for (uint32_t i = 0; i < 6; ++i) queries.emplace_back(float(i));
  const auto results = evaluate(gpu, frame, queries, R"(
    uint vertex = uint(q.x);
    r[0] = vec4(scenePosition(vertex), sceneUv(vertex).x);
    r[1] = vec4(sceneNormal(vertex), sceneUv(vertex).y);
    r[2] = vec4(octDecode(octEncode(sceneNormal(vertex))), 0.0);
  )");
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(results[3 * i], glm::vec4(geometry.positions[i], geometry.uvs[i].x));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(results[3 * i + 1][c], geometry.normals[i][c], 1e-6) << "vertex " << i;
      EXPECT_NEAR(results[3 * i + 2][c], geometry.normals[i][c], 1e-6) << "vertex " << i;
    }
    EXPECT_EQ(results[3 * i + 1].w, geometry.uvs[i].y);
  }
  const auto blocks = evaluate(gpu, frame, {glm::vec4(0), glm::vec4(1), glm::vec4(2), glm::vec4(3)}, R"(
    if (i < 2u) {
      uvec4 t = sceneTriangle(i);
      r[0] = vec4(t.xyz, materialOf(t));
      r[1] = vec4(objectOf(t), frame.triangleCount, frame.staticTriangleCount, frame.vertexCount);
      r[2] = vec4(frame.index, frame.seed, frame.time, frame.exposure);
    } else if (i == 2u) {
      r[0] = vec4(frame.boundsMin, 0.0);
      r[1] = vec4(frame.boundsMax, 0.0);
      r[2] = vec4(frame.environment, 0.0);
    } else {
      r[0] = view.clipToWorld * view.worldToClip * vec4(1.0, 2.0, 1.0, 1.0);
      r[1] = vec4(view.eye, view.size.x);
      r[2] = vec4(view.gaze, view.size.y, view.inverseSize.x * view.size.x);
    }
  )");
  EXPECT_EQ(blocks[0], glm::vec4(0, 1, 2, 3));
  EXPECT_EQ(blocks[3], glm::vec4(5, 4, 3, 7));
  EXPECT_EQ(blocks[1], glm::vec4(0, 2, 1, 6));
  EXPECT_EQ(blocks[4], glm::vec4(1, 2, 1, 6));
  EXPECT_EQ(blocks[2], glm::vec4(11, 77, 0.25f, 1.5f));
  EXPECT_EQ(glm::vec3(blocks[6]), geometry.boundsMin);
  EXPECT_EQ(glm::vec3(blocks[7]), geometry.boundsMax);
  EXPECT_EQ(glm::vec3(blocks[8]), scene.environment);
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(blocks[9][c], glm::vec4(1, 2, 1, 1)[c], 1e-4);
  EXPECT_EQ(blocks[10], glm::vec4(1 + kMaxViews - 1, 2, 3, 64 + kMaxViews - 1));  // the last view
  EXPECT_EQ(glm::vec3(blocks[11]), glm::vec3(0.25f, 0.75f, 32));
}

TEST(SceneGlsl, ObjectsEqualTheFrames) {
  Scene scene;
  scene.materials.emplace_back();
  Geometry objects;
  objects.objects.resize(40);
  GpuScene gpu(testDevice(), scene, objects, 2);
  Frame frame;
  for (uint32_t k = 0; k < 40; ++k) {
    ObjectTransform o;
    const auto transform = [&](uint32_t seed) {
      const glm::vec3 axis(random(seed, k), random(seed + 1, k), 0.1f);
      glm::mat4 m =
          glm::translate(glm::mat4(1), 10.0f * glm::vec3(random(seed + 2, k), -1, random(seed + 3, k)));
      m = glm::rotate(m, 6.0f * random(seed + 4, k), glm::normalize(axis));
      return glm::scale(m, glm::vec3(0.5f + random(seed + 5, k), 2, k % 3 == 0 ? -1.0f : 1.5f));
    };
    o.toWorld = transform(10);
    o.previousToWorld = transform(20);
    o.toObject = glm::inverse(o.toWorld);
    o.visible = k % 4 != 0;
    o.previousVisible = k % 5 != 0;
    if (k < 39) frame.objects.push_back(o);  // of the last one the frame says nothing
  }
  std::vector<glm::vec4> queries;
  for (uint32_t k = 0; k < 400; ++k)
    queries.emplace_back(3 * random(31, k), 2 * random(32, k) - 1, random(33, k) + 0.1f, float(k % 40));
  const auto places = evaluate(gpu, frame, queries, R"(
    uint object = uint(q.w);
    r[0] = vec4(fromObject(object, q.xyz), objectVisible(object) ? 1.0 : 0.0);
    r[1] = vec4(toObject(object, q.xyz), objectWasVisible(object) ? 1.0 : 0.0);
    r[2] = vec4(previousObjectTransform(object) * vec4(q.xyz, 1.0), 0.0);
  )");
  const auto normals = evaluate(gpu, frame, queries, R"(
    uint object = uint(q.w);
    r[0] = vec4(normalFromObject(object, normalize(q.xyz)), 0.0);
    r[1] = vec4(normalToObject(object, normalize(q.xyz)), 0.0);
  )");
  const auto near = [](glm::vec4 got, glm::vec3 expected) {
    return glm::distance(glm::vec3(got), expected) < 1e-5f * (1 + glm::length(expected));
  };
  for (size_t i = 0; i < queries.size(); ++i) {
    const size_t object = i % 40;
    const ObjectTransform o = object < 39 ? frame.objects[object] : ObjectTransform{};
    const glm::vec3 p(queries[i]), n = glm::normalize(p);
    ASSERT_TRUE(near(places[3 * i], o.fromObject(p))) << object;
    ASSERT_TRUE(near(places[3 * i + 1], o.intoObject(p))) << object;
    ASSERT_TRUE(near(places[3 * i + 2], glm::vec3(o.previousToWorld * glm::vec4(p, 1)))) << object;
    ASSERT_EQ(places[3 * i].w, float(o.visible));
    ASSERT_EQ(places[3 * i + 1].w, float(o.previousVisible));
    ASSERT_TRUE(near(normals[3 * i], o.normalFromObject(n))) << object;
    ASSERT_TRUE(near(normals[3 * i + 1], o.normalIntoObject(n))) << object;
  }
}

TEST(SceneGlsl, AnEmptySceneWorks) {
  GpuScene gpu(testDevice(), Scene{}, {}, 2);
  EXPECT_EQ(gpu.triangleCount(), 0u);
  const auto results = evaluate(gpu, Frame{}, {glm::vec4(0)}, R"(
    r[0] = vec4(frame.triangleCount + frame.lightCount + frame.vertexCount, frame.boundsMin);
    r[1] = vec4(frame.boundsMax, 0.0);
  )");
  EXPECT_EQ(results[0], glm::vec4(0));
  EXPECT_EQ(results[1], glm::vec4(0));
}

TEST(SceneGlsl, LightPassesBlendAndGlassAsOnTheCpu) {
  Scene scene = texturedScene();
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    if (i % 4 == 1) m.masked = m.blended = true, m.alphaCutoff = 0.5f;
    if (i % 3 != 0) m.transmission = random(30, i);
    m.roughness = random(31, i);
    m.ior = 1 + random(32, i);
    if (i % 7 == 0) m.transmissionTexture = {(i / 9 + 3) % 16, Wrap::Repeat, Wrap::Repeat};
    if (i % 7 == 1) m.metallicRoughnessTexture = {(i / 9 + 2) % 16, Wrap::Repeat, Wrap::Repeat};
    // Steep textures would turn the precision of coordinates into differences.
    m.baseColorTexture.transform = {0.01f, 0, 0, 0.01f, random(33, i), random(34, i)};
  }
  GpuScene gpu(testDevice(), scene, {}, 2, true), diffuse(testDevice(), scene, {}, 2);
  std::vector<glm::vec4> queries;
  for (uint32_t k = 0; k < scene.materials.size() * 32; ++k)
    queries.emplace_back(float(k / 32), random(35, k), random(36, k), random(37, k));
  const char* body = R"(
    uint m = uint(q.x);
    r[0] = vec4(passage(m, q.yz, q.w), stops(m, q.yz, 1.0, q.w, 0.3) ? 1.0 : 0.0,
                stops(m, q.yz, 1.0, q.w, 0.7) ? 1.0 : 0.0, 0.0);
  )";
  const auto results = evaluate(gpu, Frame{}, queries, body),
             solid = evaluate(diffuse, Frame{}, queries, body);
  uint32_t stopped = 0, passed = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Material& m = scene.materials[size_t(queries[i].x)];
    const glm::vec2 uv(queries[i].y, queries[i].z);
    const float passes = passage(scene, m, uv, queries[i].w), covers = coverage(scene, m, uv);
    if (m.transmission > 0) {
      EXPECT_NEAR(results[3 * i].x, passes, 3e-3) << i;  // the table's resolution
    }
    const float stops = covers * (1 - passes);
    for (int k = 0; k < 2; ++k) {
      const float chance = k == 0 ? 0.3f : 0.7f;
      if (std::abs(stops - chance) > 5e-3f) {
        EXPECT_EQ(results[3 * i][1 + k], float(stops > chance)) << i;
      }
      const float alpha = reflectance(scene, m, uv).a;
      if (std::abs(alpha - m.alphaCutoff) > 1e-3f) {
        EXPECT_EQ(solid[3 * i][1 + k], float(!m.masked || alpha >= m.alphaCutoff)) << i;
      }
    }
    stopped += stops > 0.7f;
    passed += stops < 0.3f;
  }
  EXPECT_GT(std::min(stopped, passed), 200u);
}

TEST(SceneGlsl, RaysPassWhereTheyDoOnTheCpu) {
  std::vector<glm::vec4> queries;
  for (uint32_t k = 0; k < 256; ++k)
    queries.emplace_back(k, float(hashPcg(k) % 4096), float(hashPcg(k + 256) % 4096),
                         float(hashPcg(k + 512) % 1000));
  GpuScene gpu(testDevice(), Scene{}, {}, 2, true);
  const auto results = evaluate(gpu, Frame{}, queries, R"(
    r[0] = vec4(passageChance(hashPcg(uint(q.x)), uvec2(q.yz), uint(q.w)), 0.0, 0.0, 0.0);
  )");
  for (size_t i = 0; i < queries.size(); ++i)
    EXPECT_EQ(results[3 * i].x, passageChance(hashPcg(uint32_t(i)), glm::uvec2(queries[i].y, queries[i].z),
                                              uint32_t(queries[i].w)));
}

TEST(SceneGlsl, ManyLargeTexturesTakeSeveralPages) {
  Scene scene;
  for (uint32_t i = 0; i < 24; ++i) {
    Texture t{"flat", 1024, 700, i % 2 == 0, std::vector<uint8_t>(1024 * 700 * 4, uint8_t(10 * i))};
    scene.textures.push_back(std::move(t));
    scene.materials.emplace_back().baseColorTexture.texture = i;
  }
  GpuScene gpu(testDevice(), scene, {}, 2);
  std::vector<glm::vec4> queries;
  for (uint32_t k = 0; k < 24 * 16; ++k) queries.emplace_back(float(k / 16), random(1, k), random(2, k), 0);
  const auto results = evaluate(gpu, Frame{}, queries, "r[0] = materialReflectance(uint(q.x), q.yz);");
  for (size_t i = 0; i < queries.size(); ++i) {
    const glm::vec4 expected = reflectance(scene, scene.materials[i / 16], {queries[i].y, queries[i].z});
    for (int c = 0; c < 4; ++c) ASSERT_NEAR(results[3 * i][c], expected[c], 1e-4) << "texture " << i / 16;
  }
}

TEST(SceneGlsl, LimitsAreNamed) {
  const struct {
    LightType type;
    size_t count;
    const char* says;
  } cases[] = {{LightType::Directional, kMaxLights + 1, "129 lights"},
               {LightType::Point, 97, "582 shadow maps"}};
  for (const auto& c : cases) {
    Scene scene;
    Light light;
    light.type = c.type;
    scene.lights.assign(c.count, light);
    try {
      GpuScene gpu(testDevice(), scene, {}, 2);
      FAIL() << c.says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      EXPECT_NE(std::string(e.what()).find(c.says), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace fovea::scene
