// Tests what the glTF loader reads, on models written here.
#include <gmock/gmock.h>

#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOfText;
using test::loadText;
using test::TemporaryFolder;
using test::TriangleDocument;
using test::warningsOfText;
using testing::AllOf;
using testing::HasSubstr;

TEST(Gltf, LoadsATriangleAndGivesItItsFlatNormal) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, TriangleDocument{}.json(), warnings);
  ASSERT_EQ(warnings.list().size(), 1u) << warnings.format();
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("meshes[0].primitives[0]"), HasSubstr("has no material")));
  ASSERT_EQ(s.meshes.size(), 1u);
  ASSERT_EQ(s.meshes[0].primitives.size(), 1u);
  const Primitive& p = s.meshes[0].primitives[0];
  EXPECT_EQ(p.indices, (std::vector<uint32_t>{0, 1, 2}));
  ASSERT_EQ(p.normals.size(), 3u);
  for (const glm::vec3& n : p.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  ASSERT_EQ(s.materials.size(), 1u);
  EXPECT_EQ(s.materials[0].metallic, 0.0f);
  EXPECT_EQ(s.materials[0].baseColor, glm::vec4(0.8f, 0.8f, 0.8f, 1.0f));
}

TEST(Gltf, GlbAndGltfOfTheSameContentHaveTheSameHash) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene a = loadText(folder, TriangleDocument{}.json(), warnings);
  const Scene b = loadText(folder, TriangleDocument{}.glb(), warnings, "model.glb");
  EXPECT_EQ(a.hash, b.hash);
  TriangleDocument other;
  other.bytes[3] = char(0x3f);  // another first coordinate
  EXPECT_NE(loadText(folder, other.json(), warnings).hash, a.hash);
}

TEST(Gltf, BufferInAFileBesideTheModelMayBeLongerThanNeeded) {
  TemporaryFolder folder;
  TriangleDocument d;
  d.bufferUri = "data%20files/tri.bin";
  folder.write("data files/tri.bin", d.bytes + "tail");
  Diagnostics warnings;
  EXPECT_EQ(flatten(loadText(folder, d.json(), warnings)).triangles.size(), 1u);
}

TEST(Gltf, ReadsMaterialsWithStrengthTransformAndMask) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra =
      R"(,"extensionsUsed":["KHR_materials_emissive_strength"],"extensionsRequired":["KHR_materials_emissive_strength"],
      "materials":[{"name":"m","alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"emissiveFactor":[1,0.5,0],
      "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8}},
      "pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,0.75],"metallicFactor":0.5}}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  ASSERT_EQ(s.materials.size(), 1u);
  const Material& m = s.materials[0];
  EXPECT_TRUE(m.masked);
  EXPECT_FALSE(m.blended);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.alphaCutoff, 0.25f);
  EXPECT_EQ(m.emission, glm::vec3(8, 4, 0));
  EXPECT_EQ(reflectance(s, m, glm::vec2(0)), glm::vec4(0.25f, 0.125f, 0.0625f, 0.75f));
}

TEST(Gltf, BlendBecomesMaskWithAWarning) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra = R"(,"materials":[{"name":"glass","alphaMode":"BLEND","alphaCutoff":0.9}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  EXPECT_TRUE(s.materials[0].masked);
  EXPECT_TRUE(s.materials[0].blended);
  EXPECT_EQ(s.materials[0].alphaCutoff, 0.5f);
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("BLEND"), HasSubstr("glass")));
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
  for (const int mode : {5, 6}) {
    TriangleDocument d;
    d.bytes.clear();
    // A square in the order of a strip, or around its first corner for the fan; both face +Z.
    if (mode == 5)
      test::appendBytes<float>(d.bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    else
      test::appendBytes<float>(d.bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    d.primitive = R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + "}";
    d.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}])";
    d.views = R"([{"buffer":0,"byteLength":48}])";
    TemporaryFolder folder;
    Diagnostics warnings;
    const Geometry g = flatten(loadText(folder, d.json(), warnings));
    ASSERT_EQ(g.triangles.size(), 2u) << "mode " << mode;
    for (const glm::vec3& n : g.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1)) << "mode " << mode;
  }
}

TEST(Gltf, QuantizedPositionsAndNormals) {
  TriangleDocument d;
  d.bytes.clear();
  test::appendBytes<int16_t>(d.bytes, {0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0});  // stride 8
  test::appendBytes<int8_t>(d.bytes, {0, 0, -127, 0, 0, 0, -127, 0, 0, 0, -128, 0});   // stride 4
  test::appendBytes<uint16_t>(d.bytes, {0, 1, 2, 0});
  d.primitive = R"({"attributes":{"POSITION":0,"NORMAL":2},"indices":1})";
  d.accessors =
      R"([{"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"},
          {"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"},
          {"bufferView":1,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"}])";
  d.views =
      R"([{"buffer":0,"byteLength":24,"byteStride":8},{"buffer":0,"byteOffset":24,"byteLength":12,"byteStride":4},
          {"buffer":0,"byteOffset":36,"byteLength":6}])";
  d.extra = R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  const Primitive& p = s.meshes.at(0).primitives.at(0);
  EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));  // -32768 clamps to -1
  for (const glm::vec3& n : p.normals) EXPECT_EQ(n, glm::vec3(0, 0, -1));
}

TEST(Gltf, SparseAccessorWithoutAView) {
  TriangleDocument d;
  d.bytes.clear();
  test::appendBytes<uint16_t>(d.bytes, {1, 2});
  test::appendBytes<float>(d.bytes, {2, 0, 0, 0, 3, 0});
  d.primitive = R"({"attributes":{"POSITION":0}})";
  d.accessors =
      R"([{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,
          "indices":{"bufferView":0,"componentType":5123},"values":{"bufferView":1}}}])";
  d.views = R"([{"buffer":0,"byteLength":4},{"buffer":0,"byteOffset":4,"byteLength":24}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  EXPECT_EQ(s.meshes.at(0).primitives.at(0).positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}));
  d.bytes[0] = 3;
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("index 3 of an accessor with 3 elements"));
}

TEST(Gltf, DegenerateTrianglesAreDroppedAndCounted) {
  TriangleDocument d;
  d.bytes = test::triangleBytes().substr(0, 36);
  test::appendBytes<uint16_t>(d.bytes, {0, 1, 2, 0, 1, 1, 2, 2, 2, 0});
  d.accessors =
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":9,"type":"SCALAR"}])";
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":18}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_EQ(flatten(loadText(folder, d.json(), warnings)).triangles.size(), 1u);
  EXPECT_THAT(warnings.format(), HasSubstr("2 triangles without area"));
}

TEST(Gltf, CamerasAndLightsTakeTheirNodesPlace) {
  TriangleDocument d;
  d.nodes =
      R"([{"mesh":0,"children":[1,2]},
          {"camera":0,"translation":[1,2,3],"rotation":[0,0.7071067811865476,0,0.7071067811865476]},
          {"translation":[0,5,0],"scale":[3,3,3],"rotation":[-0.7071067811865476,0,0,0.7071067811865476],
           "extensions":{"KHR_lights_punctual":{"light":0}}}])";
  d.extra =
      R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"zfar":50}}],
      "extensionsUsed":["KHR_lights_punctual"],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":10,"color":[1,0.5,0.25],"range":7,
      "spot":{"innerConeAngle":0.1,"outerConeAngle":0.6}}]}})";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  ASSERT_EQ(s.cameras.size(), 1u);
  const Camera& c = s.cameras[0];
  EXPECT_EQ(c.position, glm::vec3(1, 2, 3));
  EXPECT_LT(glm::distance(c.orientation * glm::vec3(0, 0, -1), glm::vec3(-1, 0, 0)), 1e-6f);
  EXPECT_FLOAT_EQ(c.verticalFov, 0.7f);
  EXPECT_FLOAT_EQ(c.zFar, 50.0f);
  ASSERT_EQ(s.lights.size(), 1u);
  const Light& l = s.lights[0];
  EXPECT_EQ(l.type, LightType::Spot);
  EXPECT_EQ(l.position, glm::vec3(0, 5, 0));
  EXPECT_LT(glm::distance(l.direction, glm::vec3(0, -1, 0)),
            1e-6f);  // and no longer than 1 for all the scale
  EXPECT_EQ(l.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(l.intensity, 10);
  EXPECT_FLOAT_EQ(l.range, 7);
  EXPECT_FLOAT_EQ(l.innerConeAngle, 0.1f);
  EXPECT_FLOAT_EQ(l.outerConeAngle, 0.6f);
}

// Two joints, one moved up by 3: a vertex between them moves up by its share, wherever the mesh's own node is.
TEST(Gltf, SkinnedMeshesStandAsTheirJointsHoldThem) {
  TriangleDocument d;
  d.bytes.resize(44);
  test::appendBytes<uint8_t>(d.bytes, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});         // joints at 44
  test::appendBytes<uint8_t>(d.bytes, {255, 0, 0, 0, 0, 255, 0, 0, 51, 204, 0, 0});  // weights at 56
  std::vector<float> bind(32, 0.0f);
  for (const size_t m : {0u, 16u})
    for (const size_t i : {0u, 5u, 10u, 15u}) bind[m + i] = 1.0f;
  bind[16 + 13] = -1.0f;             // the second joint was bound at y = 1
  test::appendBytes(d.bytes, bind);  // at 68
  d.primitive = R"({"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1})";
  d.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
      {"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"},
      {"bufferView":3,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"},
      {"bufferView":4,"componentType":5126,"count":2,"type":"MAT4"}])";
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":12},{"buffer":0,"byteOffset":56,"byteLength":12},
      {"buffer":0,"byteOffset":68,"byteLength":128}])";
  d.nodes = R"([{"mesh":0,"skin":0,"translation":[100,0,0]},{"children":[2]},{"translation":[0,4,0]}])";
  d.scenes = R"([{"nodes":[0,1]}])";
  d.extra = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":4}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Geometry g = flatten(loadText(folder, d.json(), warnings));
  ASSERT_EQ(g.positions.size(), 3u);
  EXPECT_LT(glm::distance(g.positions[0], glm::vec3(0, 0, 0)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[1], glm::vec3(1, 3, 0)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[2], glm::vec3(0, 1 + 0.8f * 3, 0)), 1e-5f);
  d.bytes[44] = 7;
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("joint 7 of a skin with 2 joints"), HasSubstr("unskinned")));
  d.bytes[44] = 0;
  d.extra = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":0}])";
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("skins[0]"), HasSubstr("MAT4"), HasSubstr("unskinned")));
}

// Eight joints of weight 1/16 in the first set and 3/16 in the second, each moved along x by its number.
TEST(Gltf, AllSetsOfJointsCount) {
  TriangleDocument d;
  d.bytes.resize(44);
  for (int vertex = 0; vertex < 3; ++vertex) test::appendBytes<uint8_t>(d.bytes, {0, 1, 2, 3});
  for (int vertex = 0; vertex < 3; ++vertex) test::appendBytes<uint8_t>(d.bytes, {4, 5, 6, 7});
  test::appendBytes(d.bytes, std::vector<float>(12, 1 / 16.0f));
  test::appendBytes(d.bytes, std::vector<float>(12, 3 / 16.0f));
  const std::string floats = R"("componentType":5126,"count":3,"type":"VEC4"})";
  const std::string bytes = R"("componentType":5121,"count":3,"type":"VEC4"})";
  d.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
      {"bufferView":2,)" +
                bytes + R"(,{"bufferView":2,"byteOffset":12,)" + bytes + R"(,{"bufferView":3,)" + floats +
                R"(,{"bufferView":3,"byteOffset":48,)" + floats + "]";
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
      {"buffer":0,"byteOffset":44,"byteLength":24},{"buffer":0,"byteOffset":68,"byteLength":96}])";
  d.nodes = R"([{"mesh":0,"skin":0})";
  std::string roots = "0", joints;
  for (int i = 0; i < 8; ++i) {
    d.nodes += R"(,{"translation":[)" + std::to_string(i) + ",0,0]}";
    roots += "," + std::to_string(i + 1);
    joints += (i ? "," : "") + std::to_string(i + 1);
  }
  d.nodes += "]";
  d.scenes = R"([{"nodes":[)" + roots + "]}]";
  d.extra = R"(,"skins":[{"joints":[)" + joints + "]}]";
  const auto xOf = [&](const std::string& attributes) {
    d.primitive = R"({"attributes":{"POSITION":0,)" + attributes + R"(},"indices":1})";
    TemporaryFolder folder;
    Diagnostics warnings;
    const Scene s = loadText(folder, d.json(), warnings);
    const Geometry g = flatten(s);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(g.positions[i].x - float(i == 1), g.positions[0].x, 1e-5f);
    return g.positions.at(0).x;
  };
  EXPECT_NEAR(xOf(R"("JOINTS_0":2,"JOINTS_1":3,"WEIGHTS_0":4,"WEIGHTS_1":5)"), (6 + 3 * 22) / 16.0f, 1e-5f);
  EXPECT_NEAR(xOf(R"("JOINTS_0":2,"WEIGHTS_0":4)"), 1.5f, 1e-5f);  // weights are normalised
  EXPECT_NEAR(xOf(R"("JOINTS_0":3,"WEIGHTS_0":4,"WEIGHTS_1":5)"), 5.5f, 1e-5f);
  EXPECT_THAT(warningsOfText(d.json()), HasSubstr("WEIGHTS_1 without JOINTS_1"));
}

// glTF 2.0, 2.7: a whole number may have a fraction or an exponent.
TEST(Gltf, IntegersInEverySpelling) {
  TemporaryFolder folder;
  Diagnostics warnings;
  TriangleDocument d;
  d.bytes.resize(44);
  const uint64_t hash = loadText(folder, d.json(), warnings).hash;
  for (const char* tail : {".0", "e0", ".0e0", "E+0", ".00e-0"}) {
    std::string text = d.json();
    for (const char* key : {"scene", "mesh", "POSITION", "indices", "bufferView", "componentType", "count",
                            "buffer", "byteLength", "byteOffset"}) {
      const std::string quoted = "\"" + std::string(key) + "\":";
      for (size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted, at + 1)) {
        const size_t end = text.find_first_not_of("0123456789", at + quoted.size());
        text.insert(end, tail);
      }
    }
    text.replace(text.find("[0]"), 3, "[0" + std::string(tail) + "]");
    EXPECT_EQ(loadText(folder, text, warnings).hash, hash) << text << warnings.format();
  }
  d.accessors.replace(d.accessors.find("\"count\":3"), 9, "\"count\":2.5");
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("accessors[0].count"), HasSubstr("a whole number")));
}

// Flat shading gives triangles vertices of their own, whose colours and joints go with them.
TEST(Gltf, ColoursOfAStripWithoutNormals) {
  TriangleDocument d;
  d.bytes.clear();
  test::appendBytes<float>(d.bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  test::appendBytes<float>(d.bytes, {0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1});
  d.primitive = R"({"attributes":{"POSITION":0,"COLOR_0":1},"mode":5})";
  d.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
      {"bufferView":1,"componentType":5126,"count":4,"type":"VEC4"}])";
  d.views = R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":64}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  const Primitive& p = s.meshes.at(0).primitives.at(0);
  ASSERT_EQ(p.colors.size(), 6u) << warnings.format();
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(p.colors[i], glm::vec4(p.positions[i].x, p.positions[i].y, 0, 1));
}

TEST(Gltf, SamplersSayHowTexturesAreFiltered) {
  const auto nearest = [](const std::string& sampler, std::string* messages = nullptr) {
    TriangleDocument d;
    d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    d.extra =
        R"(,"images":[{"uri":"data:;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC"}],
        "samplers":[{)" +
        sampler + R"(}],"textures":[{"source":0,"sampler":0}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    TemporaryFolder folder;
    Diagnostics warnings;
    const bool result = loadText(folder, d.json(), warnings).materials[0].baseColorTexture.nearest;
    if (messages) *messages = warnings.format();
    return result;
  };
  EXPECT_TRUE(nearest(R"("magFilter":9728,"minFilter":9728)"));
  for (const char* mipmap : {"9984", "9986"}) EXPECT_TRUE(nearest(std::string(R"("minFilter":)") + mipmap));
  EXPECT_TRUE(nearest(R"("magFilter":9728)"));
  EXPECT_FALSE(nearest(R"("magFilter":9729,"minFilter":9987)"));
  EXPECT_FALSE(nearest(R"("minFilter":9985)"));
  EXPECT_FALSE(nearest(""));
  std::string messages;
  EXPECT_TRUE(nearest(R"("magFilter":9728,"minFilter":9987)", &messages));
  EXPECT_THAT(messages, AllOf(HasSubstr("samplers[0]"), HasSubstr("minFilter is ignored")));
  EXPECT_FALSE(nearest(R"("magFilter":9729,"minFilter":9984)", &messages));
  EXPECT_THAT(messages, HasSubstr("minFilter is ignored"));
}

// What is valid and not read has a warning that names it.
TEST(Gltf, WhatIsNotReadIsTold) {
  const auto told = [](const char* nodes, const char* scenes, const char* extra) {
    TriangleDocument d;
    if (*nodes) d.nodes = nodes;
    if (*scenes) d.scenes = scenes;
    d.extra = extra;
    return warningsOfText(d.json());
  };
  EXPECT_THAT(
      told(R"([{"mesh":0,"name":"far","extensions":{"KHR_node_visibility":{"visible":false}}}])", "", ""),
      AllOf(HasSubstr("nodes[0] `far`"), HasSubstr("KHR_node_visibility is ignored: the node is shown")));
  EXPECT_THAT(told(R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{}}}])", "", ""),
              HasSubstr("the mesh is shown once"));
  EXPECT_THAT(told("", "", R"(,"extensionsUsed":["EXT_other"])"), HasSubstr("EXT_other"));
  EXPECT_THAT(told("", R"([{"nodes":[0]},{"nodes":[0]}])", ""), HasSubstr("1 other scene(s)"));
  EXPECT_THAT(told("", "", R"(,"materials":[{"occlusionTexture":{"index":0}}],"textures":[{}])"),
              AllOf(HasSubstr("materials[0]"), HasSubstr("occlusionTexture is ignored")));
  EXPECT_THAT(told("", "", R"(,"textures":[{"extensions":{"KHR_texture_basisu":{"source":0}}}])"),
              AllOf(HasSubstr("textures[0]"), HasSubstr("KHR_texture_basisu")));
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0,"COLOR_1":0,"JOINTS_0":0,"_OWN":0},"indices":1,
      "targets":[{"POSITION":0,"COLOR_0":0}]},{"attributes":{"POSITION":0},"mode":0},
      {"attributes":{"POSITION":0},"mode":1})";
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("COLOR_1 is ignored"), HasSubstr("JOINTS_0 without WEIGHTS_0"),
                    HasSubstr("morph targets do not change COLOR_0"), HasSubstr("primitives[1]"),
                    HasSubstr("points and lines are not drawn"), HasSubstr("primitives[2]"),
                    testing::Not(HasSubstr("_OWN"))));
}

}  // namespace
}  // namespace fovea::scene
