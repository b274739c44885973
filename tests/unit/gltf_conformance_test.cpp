// Reads every file of the shared collection: valid ones load, the others end in a clear error or load safely.
#include <gmock/gmock.h>

#include <algorithm>

#include "framework/scene/gltf/internal.h"
#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> files;
  const fs::path root = test::sharedScenes();
  std::error_code ec;
  if (!root.empty())
    for (const auto& e : fs::recursive_directory_iterator(root / folder, ec))
      if (e.path().extension() == ".gltf" || e.path().extension() == ".glb")
        files.push_back(fs::relative(e.path(), root).string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

void checkGeometry(const Scene& scene, const Geometry& g) {
  for (const Triangle& t : g.triangles) {
    for (uint32_t v : t.v) ASSERT_LT(v, g.positions.size());
    ASSERT_LT(t.material(), scene.materials.size());
    ASSERT_LT(t.object(), g.objects.size());
  }
  for (const glm::vec3& n : g.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-4f);
  for (const Material& m : scene.materials)
    for (const auto use : kMaterialTextures) {
      if (m.*use) {
        ASSERT_LT((m.*use).texture, scene.textures.size());
        ASSERT_LT((m.*use).set, 2u);
      }
    }
  for (const TriangleTangents& t : g.tangents)
    for (const glm::vec3& c : t.corners) ASSERT_TRUE(std::isfinite(c.x + c.y + c.z));
  for (const auto& list : {g.tangents.size() == g.triangles.size() || g.tangents.empty(),
                           g.colors.size() == g.positions.size() || g.colors.empty(),
                           g.secondUvs.size() == g.positions.size() || g.secondUvs.empty()})
    ASSERT_TRUE(list);
}

class GltfValid : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(GltfValid);

TEST_P(GltfValid, Loads) {
  Diagnostics warnings;
  const Scene scene = loadGltf(test::sharedScenes() / GetParam(), warnings);
  const Geometry g = flatten(scene);
  EXPECT_GT(g.triangles.size(), 0u);
  EXPECT_NE(scene.hash, 0u);
  checkGeometry(scene, g);
}

INSTANTIATE_TEST_SUITE_P(Shared, GltfValid, testing::ValuesIn(filesIn("conformance/valid")), testName);

class GltfBroken : public testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(GltfBroken);

TEST_P(GltfBroken, EndsInAClearErrorOrLoadsSafely) {
  Diagnostics warnings;
  try {
    const Scene scene = loadGltf(test::sharedScenes() / GetParam(), warnings);
    const Geometry g = flatten(scene);
    checkGeometry(scene, g);
    std::cout << "loads: " << g.triangles.size() << " triangles\n" << warnings.format() << "\n";
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(ExitCode::BadInput));
    EXPECT_THAT(e.what(), HasSubstr(fs::path(GetParam()).filename().string()));
    EXPECT_GT(std::string(e.diagnostics().front().message).size(), 10u);
    std::cout << "refused: " << e.what() << "\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Malformed, GltfBroken, testing::ValuesIn(filesIn("conformance/malformed")),
                         testName);
INSTANTIATE_TEST_SUITE_P(Unsupported, GltfBroken, testing::ValuesIn(filesIn("conformance/unsupported")),
                         testName);

// The exact messages about invalid files; a loader that accepts them has not checked.
TEST(GltfConformance, BrokenFilesAreToldApart) {
  FOVEA_NEED_SCENES(root);
  const std::pair<const char*, const char*> cases[] = {
      {"malformed/assimp/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not finite"},
      {"malformed/assimp/IncorrectVertexArrays/Cube.gltf", "bufferViews[2]"},
      {"malformed/assimp/IndexOutOfRange/IndexOutOfRange.gltf", "24 vertices"},
      {"malformed/assimp/IndexOutOfRange/AllIndicesOutOfRange.gltf", "24 vertices"},
      {"malformed/assimp/MissingBin/BoxTextured.gltf", "BoxTextured0.bin is missing"},
      {"malformed/assimp/RecursiveNodes/RecursiveNodes.gltf", "own ancestor"},
      {"malformed/assimp/SchemaFailures/sceneWrongType.gltf", "BoxTextured0.bin is missing"},
      {"malformed/assimp/wrongTypes/badArray.gltf", "primitives"},
      {"malformed/tinygltf/BoundsChecking/integer-out-of-bounds.gltf", "1e+300"},
      {"malformed/tinygltf/BoundsChecking/invalid-buffer-index.gltf", "index 1 into `buffers`"},
      {"malformed/tinygltf/BoundsChecking/invalid-buffer-view-index.gltf", "index 1 into `bufferViews`"},
      {"malformed/tinygltf/BoundsChecking/invalid-primitive-indices.gltf", "index 1 into `accessors`"},
      {"malformed/tinygltf/issue-416.gltf", "version"},
      {"unsupported/gltf1_BoxTextured/BoxTextured.gltf", "\"1.0\""},
  };
  for (const auto& [file, message] : cases) {
    Diagnostics warnings;
    EXPECT_THAT(test::errorOf([&, name = file] { loadGltf(root / "conformance" / name, warnings); }),
                AllOf(HasSubstr(fs::path(file).filename().string()), HasSubstr(message)));
  }
  const std::pair<const char*, const char*> shown[] = {{"badExtension.gltf", "KHR_texture_transform"},
                                                       {"badNumber.gltf", "normalTexture.scale"},
                                                       {"badObject.gltf", "pbrMetallicRoughness"},
                                                       {"badString.gltf", "name"},
                                                       {"badUint.gltf", "index -1"}};
  for (const auto& [file, message] : shown) {
    Diagnostics warnings;
    EXPECT_FALSE(flatten(loadGltf(root / "conformance/malformed/assimp/wrongTypes" / file, warnings))
                     .triangles.empty());
    EXPECT_THAT(warnings.format(), AllOf(HasSubstr(file), HasSubstr(message)));
  }
  Diagnostics warnings;
  loadGltf(root / "conformance/unsupported/BoxTextured-pbrSpecularGlossiness/BoxTextured.gltf", warnings);
  EXPECT_THAT(warnings.format(), HasSubstr("KHR_materials_pbrSpecularGlossiness"));
}

// Compressed by other programs. The nodes of the first draw 110,336 triangles, of which 17 have no area.
TEST(GltfConformance, CompressedModelsLoad) {
  FOVEA_NEED_SCENES(root);
  const std::pair<const char*, size_t> cases[] = {{"draco/2CylinderEngine.gltf", 110319},
                                                  {"meshopt_required.glb", 21883}};
  for (const auto& [file, triangles] : cases) {
    if (!gltf::isSupported("KHR_draco_mesh_compression") && file[0] == 'd') continue;
    Diagnostics warnings;
    const Scene s = loadGltf(root / "conformance/unsupported" / file, warnings);
    const Geometry g = flatten(s);
    EXPECT_EQ(g.triangles.size(), triangles) << file;
    checkGeometry(s, g);
  }
}

TEST(GltfConformance, PunctualLights) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / "conformance/valid/own/lights_punctual.gltf", warnings);
  ASSERT_EQ(s.lights.size(), 3u);
  const auto find = [&](LightType type) {
    return *std::find_if(s.lights.begin(), s.lights.end(), [&](const Light& l) { return l.type == type; });
  };
  const Light sun = find(LightType::Directional), bulb = find(LightType::Point), spot = find(LightType::Spot);
  // The node turns -Z by -60 degrees about X.
  EXPECT_LT(glm::distance(sun.direction, glm::vec3(0, -std::sqrt(0.75f), -0.5f)), 1e-5f);
  EXPECT_FLOAT_EQ(sun.intensity, 3);
  EXPECT_LT(glm::distance(sun.color, glm::vec3(1, 0.95f, 0.8f)), 1e-6f);
  EXPECT_LT(glm::distance(bulb.position, glm::vec3(2, 1.5f, 1)), 1e-5f);
  EXPECT_FLOAT_EQ(bulb.intensity, 20);
  EXPECT_FLOAT_EQ(bulb.range, 6);
  EXPECT_LT(glm::distance(spot.position, glm::vec3(0, 3, 3)), 1e-5f);
  EXPECT_LT(glm::distance(spot.direction, glm::vec3(0, -std::sqrt(0.5f), -std::sqrt(0.5f))), 1e-5f);
  EXPECT_FLOAT_EQ(spot.innerConeAngle, 0.2f);
  EXPECT_FLOAT_EQ(spot.outerConeAngle, 0.5f);
  EXPECT_FLOAT_EQ(spot.range, 0);
  EXPECT_EQ(spot.color, glm::vec3(1));
}

TEST(GltfConformance, SparsePositionsReplaceTheirOriginals) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Geometry g =
      flatten(loadGltf(root / "conformance/valid/khronos/SimpleSparseAccessor.gltf", warnings));
  EXPECT_EQ(g.triangles.size(), 12u);
  const auto has = [&](glm::vec3 p) {
    return std::find(g.positions.begin(), g.positions.end(), p) != g.positions.end();
  };
  for (const glm::vec3 p : {glm::vec3(1, 2, 0), glm::vec3(3, 3, 0), glm::vec3(5, 4, 0)})
    EXPECT_TRUE(has(p)) << p.x;
}

TEST(GltfConformance, LayoutZoo) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / "conformance/valid/own/layout_zoo.glb", warnings);
  // The interleaved, 32-bit, quantised-colour and unindexed variants have 12 triangles each; the strip and the fan of
  // 10 vertices have 8 each.
  const size_t expected[] = {12, 12, 12, 12, 8, 8};
  for (size_t i = 0; i < 6; ++i) {
    ASSERT_EQ(s.meshes[i].primitives.size(), 1u) << i;
    EXPECT_EQ(s.meshes[i].primitives[0].indices.size() / 3, expected[i]) << i;
  }
  EXPECT_TRUE(s.meshes[6].primitives.empty());
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("points and lines"), HasSubstr("COLOR_0")));
  // Strip and fan describe flat figures that face one way.
  for (const size_t i : {4u, 5u}) {
    const auto& normals = s.meshes[i].primitives[0].normals;
    for (const glm::vec3& n : normals) EXPECT_EQ(n, normals[0]);
  }
  EXPECT_EQ(s.materials[0].baseColorTexture.wrapU, Wrap::Clamp);
  EXPECT_EQ(s.materials[0].baseColorTexture.wrapV, Wrap::Mirror);
  const glm::mat3x2& t = s.materials[1].baseColorTexture.transform;
  const float c = std::cos(0.5f), sn = std::sin(0.5f);
  const glm::vec2 uv(0.3f, 0.7f), scaled(2 * 0.3f, 3 * 0.7f);
  const glm::vec2 want(c * scaled.x + sn * scaled.y + 0.25f, -sn * scaled.x + c * scaled.y + 0.5f);
  EXPECT_LT(glm::distance(t * glm::vec3(uv, 1), want), 1e-5f);
  // 16-bit normalised texture coordinates stay within 0..1.
  for (const glm::vec2& q : s.meshes[1].primitives[0].uvs) {
    EXPECT_GE(q.x, 0);
    EXPECT_LE(q.x, 1);
  }
}

TEST(GltfConformance, MirroredHierarchyKeepsItsOutsideOutside) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Geometry g = flatten(loadGltf(root / "conformance/valid/own/interpolation.gltf", warnings));
  EXPECT_EQ(g.triangles.size(), 9u * 12u);
  for (const Triangle& t : g.triangles) {
    const glm::vec3 n =
        glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]);
    EXPECT_GT(glm::dot(n, g.normals[t.v[0]]), 0);
  }
}

struct Model {
  const char* file;
  size_t triangles, materials, textures;
};

class SharedModel : public testing::TestWithParam<Model> {};

TEST_P(SharedModel, Loads) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / GetParam().file, warnings);
  const Geometry g = flatten(s);
  EXPECT_EQ(g.triangles.size(), GetParam().triangles);
  EXPECT_EQ(s.materials.size(), GetParam().materials);
  EXPECT_EQ(s.textures.size(), GetParam().textures);
  checkGeometry(s, g);
}

INSTANTIATE_TEST_SUITE_P(All, SharedModel,
                         testing::Values(Model{"sponza/Sponza.gltf", 262266, 25, 24},
                                         Model{"flight_helmet/FlightHelmet.gltf", 94722, 6, 15},
                                         Model{"pigman/pigman.glb", 35706, 2, 2},
                                         Model{"neko_diorama/neko_diorama.gltf", 7364, 4, 3},
                                         Model{"cornell_box/scene.gltf", 32, 8, 0}),
                         [](const auto& info) {
                           return std::string(info.param.file, std::strchr(info.param.file, '/'));
                         });

TEST(SharedModels, SponzaStandsOnItsFloorWithThreeMaskedMaterials) {
  FOVEA_NEED_SCENES(root);
  Diagnostics warnings;
  const Scene s = loadGltf(root / "sponza/Sponza.gltf", warnings);
  const Geometry g = flatten(s);
  const glm::vec3 size = g.boundsMax - g.boundsMin;
  EXPECT_NEAR(size.x, 37, 1);
  EXPECT_NEAR(size.y, 16, 1);
  EXPECT_NEAR(size.z, 23, 1);
  EXPECT_EQ(std::count_if(s.materials.begin(), s.materials.end(), [](const Material& m) { return m.masked; }),
            3);
}

}  // namespace
}  // namespace fovea::scene
