// Tests control cages from glTF files and from scene files, and the messages about invalid ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/scene/scene.h"
#include "framework/scene/subdivision/cage_builder.h"
#include "tests/support/cages.h"
#include "tests/unit/scene_support.h"

namespace fovea::scene {
namespace {

using namespace test;  // NOLINT: cages
using fovea::test::appendBytes;
using fovea::test::errorOf;
using fovea::test::loadsChanged;
using fovea::test::loadText;
using fovea::test::TemporaryFolder;
using fovea::test::TriangleDocument;
using testing::AllOf;
using testing::HasSubstr;

// Triangulates the faces as fans.
std::vector<uint16_t> trianglesOf(const SubdivisionCage& cage, size_t firstFace, size_t endFace) {
  std::vector<uint16_t> list;
  size_t first = 0;
  for (size_t f = 0; f < endFace; first += cage.faceSizes[f++])
    for (uint32_t k = 2; f >= firstFace && k < cage.faceSizes[f]; ++k)
      for (uint32_t i : {0u, k - 1, k}) list.push_back(uint16_t(cage.faceVertices[first + i]));
  return list;
}

// The cage's points as they are, with its faces [0, firstOfSecond) in one primitive and the rest in another.
TriangleDocument document(const SubdivisionCage& cage, const std::string& extras, size_t firstOfSecond = 0) {
  TriangleDocument d;
  d.bytes.clear();
  const std::vector<uint16_t> a = trianglesOf(cage, 0, firstOfSecond ? firstOfSecond : cage.faceSizes.size()),
                              b = trianglesOf(cage, firstOfSecond ? firstOfSecond : cage.faceSizes.size(),
                                              cage.faceSizes.size());
  const size_t positions = cage.positions.size() * 12, second = positions + (a.size() * 2 + 3) / 4 * 4;
  for (const glm::vec3& p : cage.positions) appendBytes<float>(d.bytes, {p.x, p.y, p.z});
  appendBytes(d.bytes, a);
  d.bytes.resize(second);
  appendBytes(d.bytes, b);
  d.bytes.resize((d.bytes.size() + 3) / 4 * 4);
  const auto text = [](size_t n) { return std::to_string(n); };
  const auto accessor = [&](int view, int type, size_t count, const char* shape) {
    return R"({"bufferView":)" + std::to_string(view) + R"(,"componentType":)" + std::to_string(type) +
           R"(,"count":)" + text(count) + R"(,"type":")" + shape + R"("})";
  };
  d.accessors =
      "[" + accessor(0, 5126, cage.positions.size(), "VEC3") + "," + accessor(1, 5123, a.size(), "SCALAR");
  d.views = R"([{"buffer":0,"byteLength":)" + text(positions) + R"(},{"buffer":0,"byteOffset":)" +
            text(positions) + R"(,"byteLength":)" + text(a.size() * 2) + "}";
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0,)"
                "\n"
                R"("extras":)" +
                extras + "}";
  if (!b.empty()) {
    d.accessors += "," + accessor(2, 5123, b.size(), "SCALAR");
    d.views +=
        R"(,{"buffer":0,"byteOffset":)" + text(second) + R"(,"byteLength":)" + text(b.size() * 2) + "}";
    d.primitive += R"(,{"attributes":{"POSITION":0},"indices":2,"material":1,"extras":)" + extras + "}";
  }
  d.accessors += "]";
  d.views += "]";
  d.extra = R"(,"materials":[{"name":"a"},{"name":"b"}])";
  return d;
}

std::string cageExtras(const std::string& content) { return R"({"fovea_subdivision":{)" + content + "}}"; }

Scene loadCage(const TriangleDocument& d) {
  TemporaryFolder folder;
  Diagnostics warnings;
  Scene scene = loadText(folder, d.json(), warnings);
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
  return scene;
}

void expectSame(const std::vector<Primitive>& a, const std::vector<Primitive>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].material, b[i].material);
    EXPECT_EQ(a[i].positions, b[i].positions);
    EXPECT_EQ(a[i].normals, b[i].normals);
    EXPECT_EQ(a[i].indices, b[i].indices);
  }
}

// The cage with its points in the order in which the faces name them, as the builder numbers them.
SubdivisionCage renumbered(const SubdivisionCage& cage) {
  SubdivisionCage out = cage;
  std::vector<uint32_t> to(cage.positions.size(), kNoIndex);
  out.positions.clear();
  for (uint32_t& v : out.faceVertices) {
    if (to[v] == kNoIndex) {
      to[v] = uint32_t(out.positions.size());
      out.positions.push_back(cage.positions[v]);
    }
    v = to[v];
  }
  for (SubdivisionCage::Crease& c : out.creases) c.a = to[c.a], c.b = to[c.b];
  for (SubdivisionCage::Corner& c : out.corners) c.vertex = to[c.vertex];
  return out;
}

TEST(CageFiles, QuadsOfAGltfFileAreKept) {
  const std::vector<Primitive> expected = refine(renumbered(cubeCage(3)));
  for (const char* sizes :
       {R"("faceSizes":4,"level":3)", R"("faceSizes":[4,4,4,4,4,4],"level":3,"scheme":"catmull-clark")"}) {
    const Scene s = loadCage(document(cubeCage(3), cageExtras(sizes)));
    ASSERT_EQ(s.meshes.size(), 1u);
    ASSERT_TRUE(s.meshes[0].cage);
    EXPECT_EQ(s.meshes[0].cage->faceSizes, std::vector<uint32_t>(6, 4));
    expectSame(s.meshes[0].primitives, expected);
    EXPECT_EQ(flatten(s).triangles.size(), 6u * 16 * 4 * 2);
  }
}

TEST(CageFiles, TrianglesForLoopAndCreases) {
  SubdivisionCage cage = tetrahedronCage(2);
  cage.creases = {{0, 1, 10}, {1, 2, 1.5f}};
  cage.corners = {{3, 10}};
  const Scene s = loadCage(document(cage, cageExtras(R"("scheme":"loop","level":2,
      "creases":[[0,1,10],[1,2,1.5]],"corners":[[3,10]])")));
  expectSame(s.meshes[0].primitives, refine(renumbered(cage)));
}

TEST(CageFiles, PrimitivesOfAMeshAreOneCage) {
  SubdivisionCage cage = cubeCage(2);
  cage.faceMaterials = {0, 0, 1, 1, 1, 1};
  const Scene s = loadCage(document(cage, cageExtras(R"("faceSizes":4)"), 2));
  expectSame(s.meshes[0].primitives, refine(renumbered(cage)));
}

// Vertices split for texture coordinates and normals are merged again.
TEST(CageFiles, SplitVerticesAreOnePoint) {
  const SubdivisionCage cube = cubeCage(2);
  Primitive split;
  for (uint32_t v : cube.faceVertices) split.positions.push_back(cube.positions[v]);
  for (uint32_t f = 0; f < 6; ++f) split.uvs.insert(split.uvs.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  MorphTarget target;
  for (const glm::vec3& p : split.positions) target.positions.push_back(0.5f * p);
  split.targets = {target};
  split.joints.assign(24, glm::u16vec4(1, 0, 0, 0));
  split.weights.assign(24, glm::vec4(1, 0, 0, 0));
  CageBuilder builder;
  builder.begin(split);
  EXPECT_EQ(builder.point(3), kNoIndex);
  for (uint32_t f = 0; f < 6; ++f) {
    const uint32_t corners[] = {4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3};
    builder.face(corners);
  }
  SubdivisionCage cage = builder.take();
  EXPECT_TRUE(checkCage(cage).empty());
  ASSERT_EQ(cage.positions.size(), 8u);
  ASSERT_EQ(cage.targets.size(), 1u);
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(cage.targets[0].positions[i], 0.5f * cage.positions[i]);
    EXPECT_EQ(cage.joints[i].x, 1);
  }
  EXPECT_LT(cage.uvs.size(), 24u) << "the same texture coordinates in the same place are one";
  creaseByAngle(cage, 91);
  EXPECT_TRUE(cage.creases.empty());
  creaseByAngle(cage, 89);
  EXPECT_EQ(cage.creases.size(), 12u);
}

struct BadCage {
  const char* name;
  const char* content;
  const char* place;
  const char* message;
};
class BadCageFiles : public testing::TestWithParam<BadCage> {};

TEST_P(BadCageFiles, AreRefusedWithTheirPlace) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const std::string text = document(cubeCage(2), cageExtras(GetParam().content)).json();
  EXPECT_THAT(errorOf([&] { loadText(folder, text, warnings); }),
              AllOf(HasSubstr("model.gltf:2:"), HasSubstr(GetParam().place), HasSubstr(GetParam().message)));
}

const BadCage kBadCages[] = {
    {"UnknownKey", R"("faceSizes":4,"lewel":3)", "fovea_subdivision.lewel", "did you mean `level`"},
    {"Scheme", R"("faceSizes":4,"scheme":"doo-sabin")", "fovea_subdivision.scheme", "catmull-clark"},
    {"LevelTooHigh", R"("faceSizes":4,"level":12)", "fovea_subdivision.level", "12"},
    {"LevelOfAText", R"("faceSizes":4,"level":"high")", "fovea_subdivision.level", "high"},
    {"LightLevelTooFine", R"("faceSizes":4,"level":3,"lightLevel":4)", "fovea_subdivision.lightLevel",
     "from 0 to 3, the picture's level, found the number 4"},
    {"LightLevelTooCoarse", R"("faceSizes":4,"lightLevel":-1)", "fovea_subdivision.lightLevel",
     "from 0 to 2, the picture's level, found the number -1"},
    {"LightLevelOfAText", R"("faceSizes":4,"lightLevel":"low")", "fovea_subdivision.lightLevel", "low"},
    {"LoopOfQuads", R"("faceSizes":4,"scheme":"loop")", "faceSizes[0]", "triangles only"},
    {"FaceOfTwo", R"("faceSizes":[4,4,2,4,4,4])", "faceSizes[2]", "from 3 to 64"},
    {"FaceOfAText", R"("faceSizes":"four")", "faceSizes", "from 3 to 64"},
    {"TooManyFaces", R"("faceSizes":[4,4,4,4,4,4,4])", "faceSizes[6]", "only 0 left"},
    {"TooFewFaces", R"("faceSizes":[4,4,4])", "faceSizes", "take 6 triangles, the primitive has 12"},
    {"NoFan", R"("faceSizes":[3,4,4,4,4,4,3])", "faceSizes[1]", "does not go on with the fan"},
    {"CreaseOfNoEdge", R"("faceSizes":4,"creases":[[0,7,1]])", "creases[0]", "no edge between"},
    {"CreasePastTheVertices", R"("faceSizes":4,"creases":[[0,1,1],[0,77,1]])", "creases[1]",
     "[vertex, vertex, sharpness]"},
    {"CreaseOfTwoNumbers", R"("faceSizes":4,"creases":[[0,1]])", "creases[0]", "[vertex, vertex, sharpness]"},
    {"CreaseNegative", R"("faceSizes":4,"creases":[[0,1,-1]])", "creases[0]", "sharpness from 0"},
    {"CreasesNoList", R"("faceSizes":4,"creases":3)", "fovea_subdivision.creases", "array"},
    {"CornerOfThree", R"("faceSizes":4,"corners":[[0,1,1]])", "corners[0]", "[vertex, sharpness]"},
};
INSTANTIATE_TEST_SUITE_P(All, BadCageFiles, testing::ValuesIn(kBadCages),
                         [](const auto& i) { return std::string(i.param.name); });

TEST(CageFiles, BadSurfacesAreRefusedWithTheirPlace) {
  const auto messageOf = [](const SubdivisionCage& cage, const std::string& extras, size_t split = 0) {
    TemporaryFolder folder;
    Diagnostics warnings;
    return errorOf([&] { loadText(folder, document(cage, extras, split).json(), warnings); });
  };
  const std::string quads = cageExtras(R"("faceSizes":4)");
  SubdivisionCage cage = cubeCage(2);
  std::swap(cage.faceVertices[1], cage.faceVertices[3]);
  EXPECT_THAT(messageOf(cage, quads), AllOf(HasSubstr("model.gltf:2:"), HasSubstr("meshes[0] `tri`"),
                                            HasSubstr("faces[4]"), HasSubstr("same direction")));
  cage = cubeCage(2);
  cage.positions[3].x = std::nanf("");
  EXPECT_THAT(messageOf(cage, quads), HasSubstr("not finite"));
  cage = cubeCage(2);
  cage.positions[3] = cage.positions[1];
  EXPECT_THAT(messageOf(cage, quads), AllOf(HasSubstr("faces["), HasSubstr("twice")));
  EXPECT_THAT(messageOf(gridCage(120, 120, 1, [](uint32_t, uint32_t) { return 0.0f; }),
                        cageExtras(R"("faceSizes":4,"level":8)")),
              AllOf(HasSubstr("level"), HasSubstr("lower the level")));
  // Only one of two primitives is a cage.
  TriangleDocument d = document(cubeCage(2), quads, 2);
  d.primitive = d.primitive.substr(0, d.primitive.rfind(",\"extras\"")) + "}";
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { loadText(folder, d.json(), warnings); }),
              AllOf(HasSubstr("primitives[1]"), HasSubstr("all of them need it, or none")));
}

// With each byte of the description and of the indices changed, the result is an error or a scene and nothing else.
TEST(CageFiles, EveryByteOfACageChanged) {
  const std::string good =
      document(tetrahedronCage(1), cageExtras(R"("scheme":"loop","level":1,"faceSizes":[3,3,3,3],
"creases":[[0,1,10],[1,2,1.5]],"corners":[[3,10]])"))
          .glb();
  TemporaryFolder folder;
  const size_t extras = good.find("fovea_subdivision"), indices = good.find("BIN") + 4 + 48;
  ASSERT_NE(extras, std::string::npos);
  int loaded = 0, refused = 0;
  for (size_t i = extras; i < good.size(); ++i) {
    if (i == extras + 120) i = std::max(i, indices);
    for (const int change : {0x01, 0x10, 0xff})
      (loadsChanged(folder, good, i, change) ? loaded : refused) += 1;
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(loaded, 10);
}

// ---- scene files ------------------------------------------------------------------------------------------

struct SceneResult {
  std::string error;
  Scene scene;
};

SceneResult loadScene(const TriangleDocument& d, const std::string& subdivision) {
  TemporaryFolder folder;
  folder.write("model.gltf", d.json());
  const auto file =
      folder.write("scene.json",
                   R"({"models": [{"file": "model.gltf",
"subdivision": )" + subdivision +
                       R"(}], "environment": [1, 1, 1], "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]}})");
  SceneResult result;
  Diagnostics warnings;
  result.error = errorOf([&] { result.scene = load(file.string(), warnings); });
  return result;
}

TEST(CageFiles, AnyMeshOfASceneFileCanBeSubdivided) {
  const TriangleDocument tetrahedron = document(tetrahedronCage(1), "{}");
  const SceneResult smooth = loadScene(tetrahedron, R"({"level": 3})");
  EXPECT_EQ(smooth.error, "");
  expectSame(smooth.scene.meshes.at(0).primitives, refine(renumbered(tetrahedronCage(3))));

  const SceneResult sharp = loadScene(tetrahedron, R"({"level": 2, "crease_deg": 60, "meshes": ["tri"]})");
  EXPECT_EQ(sharp.error, "");
  for (const glm::vec3& p : sharp.scene.meshes.at(0).primitives.at(0).positions)
    EXPECT_NEAR(std::max({-p.x - p.y - p.z, -p.x + p.y + p.z, p.x - p.y + p.z, p.x + p.y - p.z}), 1, 1e-5)
        << "still the tetrahedron";
  EXPECT_EQ(sharp.scene.meshes[0].primitives[0].positions.size(), 4u * 15) << "each face has its own normals";

  // The level of the scene file applies to a cage.
  const SceneResult finer =
      loadScene(document(cubeCage(1), cageExtras(R"("faceSizes":4,"level":1)")), R"({"level": 3})");
  expectSame(finer.scene.meshes.at(0).primitives, refine(renumbered(cubeCage(3))));
  EXPECT_NE(finer.scene.hash, smooth.scene.hash);
}

TEST(CageFiles, VoxelsAndMapsMaySeeACoarserLevel) {
  SubdivisionCage cage = renumbered(cubeCage(3));
  cage.lightLevel = 1;
  const std::vector<Primitive> want = refine(cage);
  const std::string extras = cageExtras(R"("faceSizes":4,"level":3,"lightLevel":1)");
  const Scene ofModel = loadCage(document(cubeCage(1), extras));
  EXPECT_EQ(ofModel.meshes.at(0).primitives.at(0).lightIndices, want.at(0).lightIndices);
  const TriangleDocument plain = document(cubeCage(1), cageExtras(R"("faceSizes":4)"));
  const SceneResult coarse = loadScene(plain, R"({"level": 3, "light_level": 1})"),
                    same = loadScene(plain, R"({"level": 3})");
  EXPECT_EQ(coarse.error + same.error, "");
  EXPECT_EQ(coarse.scene.meshes.at(0).primitives.at(0).lightIndices, want.at(0).lightIndices);
  EXPECT_TRUE(same.scene.meshes.at(0).primitives.at(0).lightIndices.empty());
  EXPECT_NE(coarse.scene.hash, same.scene.hash);
}

TEST(CageFiles, MistakesOfSubdivision) {
  const TriangleDocument tetrahedron = document(tetrahedronCage(1), "{}");
  const auto expect = [&](const TriangleDocument& d, const char* text, const char* place,
                          const char* message) {
    EXPECT_THAT(loadScene(d, text).error,
                AllOf(HasSubstr("scene.json:2:"), HasSubstr(place), HasSubstr(message)));
  };
  expect(tetrahedron, "3", "models[0].subdivision", "expected an object");
  expect(tetrahedron, R"({"levels": 3})", "models[0].subdivision.levels", "did you mean `level`");
  expect(tetrahedron, R"({"level": 9})", "models[0].subdivision.level", "9");
  expect(tetrahedron, R"({"level": 2, "light_level": 3})", "models[0].subdivision.light_level",
         "from 0 to 2, the picture's level, found the number 3");
  expect(tetrahedron, R"({"level": 2, "light_level": 3})", "models[0].subdivision.light_level",
         "leave it out for the same");
  expect(tetrahedron, R"({"light_level": -1})", "models[0].subdivision.light_level", "from 0 to 1");
  expect(tetrahedron, R"({"light_level": 0.5})", "models[0].subdivision.light_level", "0.5");
  expect(tetrahedron, R"({"scheme": "cubic"})", "models[0].subdivision.scheme", "catmull-clark");
  expect(tetrahedron, R"({"crease_deg": 200})", "models[0].subdivision.crease_deg", "200");
  expect(tetrahedron, R"({"meshes": ["try"]})", "models[0].subdivision", "did you mean `tri`");
  expect(tetrahedron, R"({"meshes": [1]})", "models[0].subdivision.meshes[0]", "name of a mesh");
  SubdivisionCage twice = tetrahedronCage(1);
  addFace(twice, {0, 1, 2});
  expect(document(twice, "{}"), R"({"level": 1})", "mesh `tri` is no control cage", "same direction");
}

}  // namespace
}  // namespace fovea::scene
