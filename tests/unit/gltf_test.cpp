// The glTF loader on models written here: what it reads, and that hostile files end in a message that names
// the place.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::errorOfText;
using test::loadText;
using test::TemporaryFolder;
using test::TriangleDocument;
using testing::AllOf;
using testing::HasSubstr;

TEST(Gltf, LoadsATriangleAndGivesItItsFlatNormal) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, TriangleDocument{}.json(), warnings);
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
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

// Two joints, one moved up by 3: a vertex between them moves up by its share, wherever the mesh's own node
// stands.
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
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("joint 7 of a skin with 2 joints"));
  d.bytes[44] = 0;
  d.extra = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":0}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("skins[0]"), HasSubstr("MAT4")));
}

// ---- hostile files ----

TEST(GltfHostile, DeepNestingInExtras) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  TriangleDocument d;
  d.extra = R"(,"extras":)" + deep;
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("model.gltf:1:"), HasSubstr("64")));
  EXPECT_FALSE(errorOfText(d.glb(), "model.glb").empty());
}

TEST(GltfHostile, DuplicateKeys) {
  TriangleDocument d;
  d.extra = R"(,"meshes":[])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("meshes"));
}

struct UriCase {
  const char *uri, *message;
};

class GltfUri : public testing::TestWithParam<UriCase> {};

TEST_P(GltfUri, IsRefusedForImagesAndBuffers) {
  const std::string uri = GetParam().uri;
  TriangleDocument image;
  image.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  image.extra = R"(,"images":[{"uri":")" + uri + R"("}],"textures":[{"source":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  EXPECT_THAT(errorOfText(image.json()),
              AllOf(HasSubstr("model.gltf:1:"), HasSubstr("images[0].uri"), HasSubstr(GetParam().message)));
  TriangleDocument buffer;
  buffer.bufferUri = uri.empty() ? std::string(" ") : uri;
  if (!uri.empty()) {
    EXPECT_THAT(errorOfText(buffer.json()),
                AllOf(HasSubstr("buffers[0].uri"), HasSubstr(GetParam().message)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfUri,
    testing::Values(UriCase{".", "folder"}, UriCase{"", "empty"}, UriCase{"./", "folder"},
                    UriCase{"a/..", "folder"}, UriCase{"../secret.bin", "leads out"},
                    UriCase{"a/../../secret.bin", "leads out"}, UriCase{"%2e%2e/secret.bin", "leads out"},
                    UriCase{"/etc/passwd", "absolute"}, UriCase{"%2fetc/passwd", "absolute"},
                    UriCase{"file:///etc/passwd", "beside the model"},
                    UriCase{"http://example.com/a.png", "beside the model"}, UriCase{"a%00.png", "NUL"}));

TEST(GltfHostile, NothingOutsideTheFolderIsRead) {
  // A file of the right size really lies where the uri points; it still must not be opened.
  TemporaryFolder folder;
  TriangleDocument d;
  folder.write("secret.bin", d.bytes);
  d.bufferUri = "../secret.bin";
  folder.write("in/model.gltf", d.json());
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path() / "in/model.gltf", warnings); }), HasSubstr("leads out"));
}

TEST(GltfHostile, BufferOfTheWorkingFolderIsNotTaken) {
  // tinygltf itself would look in the working folder when the model's own has no such file.
  TemporaryFolder folder;
  TriangleDocument d;
  d.bufferUri = "only_in_the_working_folder.bin";
  const auto before = std::filesystem::current_path();
  folder.write("work/" + d.bufferUri, d.bytes);
  const auto file = folder.write("model/model.gltf", d.json());
  std::filesystem::current_path(folder.path() / "work");
  Diagnostics warnings;
  const std::string message = errorOf([&] { loadGltf(file, warnings); });
  std::filesystem::current_path(before);
  EXPECT_THAT(message, HasSubstr("missing"));
}

TEST(GltfHostile, BufferFileTooShortOrNoFile) {
  TemporaryFolder folder;
  TriangleDocument d;
  d.bufferUri = "short.bin";
  folder.write("short.bin", d.bytes.substr(0, 20));
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { loadText(folder, d.json(), warnings); }),
              AllOf(HasSubstr("20 bytes"), HasSubstr("needs 44")));
  d.bufferUri = "nowhere.bin";
  EXPECT_THAT(errorOf([&] { loadText(folder, d.json(), warnings); }), HasSubstr("nowhere.bin is missing"));
}

TEST(GltfHostile, NodeCyclesAndTwoParents) {
  TriangleDocument d;
  d.nodes = R"([{"mesh":0,"children":[1]},{"children":[2]},{"children":[1]}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("nodes"), HasSubstr("one parent")));
  d.nodes = R"([{"mesh":0},{"children":[2]},{"children":[1]}])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("its own ancestor"));
  d.nodes = R"([{"mesh":0,"children":[0]}])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("its own ancestor"));
  d.nodes = R"([{"mesh":0,"children":[7]}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("nodes[0].children[0]"), HasSubstr("index 7")));
}

TEST(GltfHostile, AVeryDeepNodeChainLoads) {
  TriangleDocument d;
  constexpr int kDepth = 20000;
  d.nodes = "[";
  for (int i = 0; i < kDepth; ++i) d.nodes += R"({"children":[)" + std::to_string(i + 1) + "]},";
  d.nodes += R"({"mesh":0}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_EQ(flatten(loadText(folder, d.json(), warnings)).triangles.size(), 1u);
}

TEST(GltfHostile, AccessorsThatReachPastTheirBuffer) {
  TriangleDocument d;
  d.accessors =
      R"([{"bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])";
  EXPECT_THAT(errorOfText(d.json()),
              AllOf(HasSubstr("accessors[0]"), HasSubstr("byte 40"), HasSubstr("36 bytes")));
  d = {};
  d.views = R"([{"buffer":0,"byteLength":36,"byteStride":16},{"buffer":0,"byteOffset":36,"byteLength":6}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("accessors[0]"), HasSubstr("byte 44")));
  d = {};
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":40,"byteLength":6}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("bufferViews[1]"), HasSubstr("44 bytes")));
  d = {};
  d.views = R"([{"buffer":0,"byteLength":36,"byteStride":8},{"buffer":0,"byteOffset":36,"byteLength":6}])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("byteStride is 8"));
}

TEST(GltfHostile, HugeCountsAndOffsets) {
  for (const char* count : {"4294967296", "2147483647", "1e300", "-1", "0", "9223372036854775807"}) {
    TriangleDocument d;
    d.accessors = std::string(R"([{"bufferView":0,"componentType":5126,"count":)") + count +
                  R"(,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])";
    EXPECT_THAT(errorOfText(d.json()), HasSubstr("accessors[0]")) << count;
    d.accessors = std::string(R"([{"componentType":5126,"count":)") + count + R"(,"type":"VEC3"}])";
    d.primitive = R"({"attributes":{"POSITION":0}})";
    EXPECT_THAT(errorOfText(d.json()), HasSubstr("accessors[0]")) << count;
  }
  TriangleDocument d;
  d.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":2147483647,"byteLength":2147483647}])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("bufferViews[1]"));
}

TEST(GltfHostile, NotFinitePositionsNameMeshAndAccessor) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    TriangleDocument d;
    std::memcpy(d.bytes.data() + 16, &bad, sizeof bad);
    EXPECT_THAT(errorOfText(d.json()),
                AllOf(HasSubstr("model.gltf"), HasSubstr("`tri`"), HasSubstr("accessors[0]"),
                      HasSubstr("vertex 1"), HasSubstr("not finite")));
  }
}

TEST(GltfHostile, IndicesPastTheVertices) {
  TriangleDocument d;
  d.bytes[40] = 9;
  EXPECT_THAT(errorOfText(d.json()),
              AllOf(HasSubstr("accessors[1]"), HasSubstr("is 9"), HasSubstr("3 vertices")));
}

TEST(GltfHostile, AttributesOfOtherLengthsAndTypes) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":1})";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("NORMAL"), HasSubstr("VEC3")));
  d = {};
  d.primitive = R"({"attributes":{"POSITION":0},"indices":0})";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("indices"), HasSubstr("SCALAR")));
  d = {};
  d.primitive = R"({"attributes":{"POSITION":"zero"},"indices":1})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("attributes.POSITION"));
}

TEST(GltfHostile, ImageViewsAreChecked) {
  TriangleDocument d;
  d.extra = R"(,"images":[{"bufferView":5,"mimeType":"image/png"}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("images[0].bufferView"), HasSubstr("index 5")));
}

TEST(GltfHostile, ImageThatIsNoImage) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra =
      R"(,"images":[{"name":"noise","uri":"data:image/png;base64,AAECAwQFBgc="}],"textures":[{"source":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("model.gltf"), HasSubstr("noise")));
}

TEST(GltfHostile, MissingTextureOnlyMattersWhereItIsUsed) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra = R"(,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("gone.png"), HasSubstr("missing")));
  d.extra =
      R"(,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}])";
  EXPECT_EQ(errorOfText(d.json()), "");
}

TEST(GltfHostile, ExtensionsAndVersions) {
  TriangleDocument d;
  d.extra = R"(,"extensionsRequired":["KHR_draco_mesh_compression","EXT_other"])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("KHR_draco_mesh_compression"), HasSubstr("EXT_other")));
  d = {};
  d.asset = R"({"version":"1.0"})";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("1.0"), HasSubstr("glTF 2.0")));
  d.asset = R"({"version":"2.0","minVersion":"2.1"})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("2.1"));
  d.asset = R"({})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("version is missing"));
  EXPECT_THAT(errorOfText("[1,2,3]"), HasSubstr("an array"));
  EXPECT_THAT(errorOfText("{}"), HasSubstr("version is missing"));
  EXPECT_FALSE(errorOfText("").empty());
  EXPECT_FALSE(errorOfText("glTF").empty());
}

TEST(GltfHostile, ALightOrSpotThatCannotBe) {
  TriangleDocument d;
  d.extra = R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot"}]}})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("needs `spot`"));
  d.extra =
      R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{"innerConeAngle":0.9}}]}})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("innerConeAngle"));
  d.extra = R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"laser"}]}})";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("laser"));
  d.extra = R"(,"extensions":{"KHR_lights_punctual":{"lights":[]}})";
  d.nodes = R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}])";
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("0 lights"));
}

TEST(GltfHostile, GlbThatLiesAboutItsLengths) {
  const std::string good = TriangleDocument{}.glb();
  EXPECT_EQ(errorOfText(good, "model.glb"), "");
  const auto with = [&](size_t offset, uint32_t value) {
    std::string bad = good, bytes;
    test::appendU32(bytes, value);
    return errorOfText(bad.replace(offset, 4, bytes), "model.glb");
  };
  const size_t jsonLength = uint8_t(good[12]) | uint8_t(good[13]) << 8;
  EXPECT_THAT(with(4, 1), HasSubstr("version 1"));
  EXPECT_THAT(with(8, uint32_t(good.size()) + 4), HasSubstr("promises"));
  EXPECT_THAT(with(8, 16), HasSubstr("16 bytes"));
  EXPECT_THAT(with(12, 0xffffffff), HasSubstr("JSON chunk claims"));
  EXPECT_THAT(with(12, 0), HasSubstr("JSON chunk claims"));
  EXPECT_THAT(with(16, 0x12345678), HasSubstr("not JSON"));
  // tinygltf forgets the 8 bytes of the second chunk's header here and reads past the end.
  EXPECT_THAT(with(20 + jsonLength, uint32_t(good.size() - 20 - jsonLength)), HasSubstr("BIN chunk claims"));
  for (size_t size = 4; size < good.size(); size += 3)
    EXPECT_FALSE(errorOfText(good.substr(0, size), "model.glb").empty()) << size;
}

TEST(GltfHostile, WrongKindsOfFile) {
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path() / "none.gltf", warnings); }), HasSubstr("no such file"));
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path(), warnings); }), HasSubstr("not a regular file"));
  EXPECT_THAT(errorOf([&] { loadGltf("/dev/zero", warnings); }), HasSubstr("not a regular file"));
}

// Every byte of a small file changed in three ways: an error or a scene, never anything else.
TEST(GltfHostile, EveryByteChanged) {
  const std::string good = TriangleDocument{}.glb();
  TemporaryFolder folder;
  int loaded = 0, refused = 0;
  for (size_t i = 0; i < good.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string bad = good;
      bad[i] = char(bad[i] ^ change);
      Diagnostics warnings;
      try {
        flatten(loadText(folder, bad, warnings, "model.glb"));
        ++loaded;
      } catch (const Error& e) {
        EXPECT_EQ(int(e.code()), int(ExitCode::BadInput)) << "byte " << i << ": " << e.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(loaded, 10);
}

}  // namespace
}  // namespace fovea::scene
