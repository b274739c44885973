// Feeds hostile and broken files to the glTF loader: each ends in a message that names the position of the mistake.
#include <gmock/gmock.h>

#include <limits>

#include "fovea/image.h"
#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::errorOfText;
using test::loadsChanged;
using test::loadText;
using test::TemporaryFolder;
using test::TriangleDocument;
using test::warningsOfText;
using testing::AllOf;
using testing::HasSubstr;

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
  EXPECT_THAT(warningsOfText(image.json()),
              AllOf(HasSubstr("model.gltf:1:"), HasSubstr("images[0].uri"), HasSubstr(GetParam().message),
                    HasSubstr("the image is left out")));
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
  // A file of the expected size really lies where the uri points; it still must not be opened.
  TemporaryFolder folder;
  TriangleDocument d;
  folder.write("secret.bin", d.bytes);
  d.bufferUri = "../secret.bin";
  folder.write("in/model.gltf", d.json());
  Diagnostics warnings;
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path() / "in/model.gltf", warnings); }), HasSubstr("leads out"));
}

TEST(GltfHostile, LinksThatLeadOut) {
  TemporaryFolder folder;
  TriangleDocument d;
  d.bufferUri = "data.bin";
  folder.write("secret.bin", d.bytes);
  folder.write("in/model.gltf", d.json());
  std::filesystem::create_symlink("../secret.bin", folder.path() / "in/data.bin");
  Diagnostics warnings;
  EXPECT_THAT(
      errorOf([&] { loadGltf(folder.path() / "in/model.gltf", warnings); }),
      AllOf(HasSubstr("buffers[0].uri"), HasSubstr("link that leads out"), HasSubstr("--follow-links")));
  setenv("FOVEA_FOLLOW_LINKS", "1", 1);
  EXPECT_EQ(loadGltf(folder.path() / "in/model.gltf", warnings).meshes.size(), 1u);
  setenv("FOVEA_FOLLOW_LINKS", "yes", 1);
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path() / "in/model.gltf", warnings); }),
              HasSubstr("FOVEA_FOLLOW_LINKS is `yes`"));
  std::filesystem::remove(folder.path() / "secret.bin");
  EXPECT_THAT(errorOf([&] { loadGltf(folder.path() / "in/model.gltf", warnings); }),
              HasSubstr("is a link to ../secret.bin, which is missing"));
  unsetenv("FOVEA_FOLLOW_LINKS");
  // Links to a model and to its parts, which lie together elsewhere.
  folder.write("real/model.gltf", d.json());
  folder.write("real/data.bin", d.bytes);
  std::filesystem::create_directory(folder.path() / "links");
  for (const char* name : {"model.gltf", "data.bin"})
    std::filesystem::create_symlink(folder.path() / "real" / name, folder.path() / "links" / name);
  EXPECT_EQ(loadGltf(folder.path() / "links/model.gltf", warnings).meshes.size(), 1u);
}

TEST(GltfHostile, BackslashesInUris) {
  TemporaryFolder folder;
  TriangleDocument d;
  folder.write("parts/data.bin", d.bytes);
  const auto error = [&](const std::string& uri) {
    d.bufferUri = uri;
    Diagnostics warnings;
    const std::filesystem::path model = folder.write("model.gltf", d.json());
    return errorOf([&] { loadGltf(model, warnings); });
  };
  for (const char* uri : {R"(parts\\data.bin)", "parts%5Cdata.bin", R"(.\\parts/data.bin)"})
    EXPECT_THAT(error(uri), AllOf(HasSubstr("backslashes"), HasSubstr("parts/data.bin\""))) << uri;
  EXPECT_THAT(error(R"(..\\data.bin)"), HasSubstr("backslashes"));
  EXPECT_THAT(error(R"(\\data.bin)"), HasSubstr("absolute"));
  // A file may be called so.
  folder.write("odd\\name.bin", d.bytes);
  EXPECT_EQ(error(R"(odd\\name.bin)"), "");
}

TEST(GltfHostile, DataUriWithoutData) {
  TriangleDocument d;
  for (const char* uri :
       {"data:", "data:application/octet-stream,AAAA", "data:application/octet-stream;base64"}) {
    d.bufferUri = uri;
    EXPECT_THAT(errorOfText(d.json()),
                AllOf(HasSubstr("buffers[0].uri"), HasSubstr("no data that can be read")))
        << uri;
  }
  for (const char* uri : {"data:;base64,AA*A", "data:;base64,AA\\u00e4A"}) {
    d.bufferUri = uri;
    EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("buffers[0].uri"), HasSubstr("is not base64"))) << uri;
  }
  d.bufferUri = "data:;base64,AAAA";
  EXPECT_THAT(errorOfText(d.json()),
              AllOf(HasSubstr("buffers[0].uri"), HasSubstr("3 bytes"), HasSubstr("needs 44")));
}

// The media type says nothing: the content does.
TEST(GltfHostile, DataUrisOfEveryMediaType) {
  TriangleDocument d;
  std::string padded = test::base64(d.bytes);
  for (const char* type : {"", "application/gltf-buffer", "application/octet-stream;charset=utf-8",
                           "text/plain", "image/png", "a/b;c=d"}) {
    d.bufferUri = std::string("data:") + type + ";base64," + padded;
    EXPECT_EQ(errorOfText(d.json()), "") << type;
  }
  std::string escaped = padded;
  while (escaped.back() == '=') escaped.pop_back();
  for (const std::string& data : {escaped, escaped + "%3D%3d", padded + "AAAA", padded + "\\n"}) {
    d.bufferUri = "DATA:;BASE64," + data;
    EXPECT_EQ(errorOfText(d.json()), "") << data;
  }
  const std::string png =
      "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC";
  for (const char* type : {"", "image/png", "image/jpg", "image/PNG", "image/jpeg", "text/plain",
                           "image/png;charset=utf-8", "application/octet-stream"}) {
    TriangleDocument image;
    image.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    image.extra = R"(,"images":[{"uri":"data:)" + std::string(type) + ";base64," + png + R"("}],
        "textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    TemporaryFolder folder;
    Diagnostics warnings;
    const Scene s = loadText(folder, image.json(), warnings);
    ASSERT_EQ(s.textures.size(), 1u) << type << warnings.format();
    EXPECT_EQ(s.textures[0].rgba, (std::vector<uint8_t>{0, 0, 0, 255})) << type;
  }
}

TEST(GltfHostile, ImagesOfOneFileAreDecodedOnce) {
  TemporaryFolder folder;
  image::write(folder.path() / "a.png", {{"", {2, 2, 3, std::vector<float>(12, 0.5f)}}});
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  std::string images, textures, materials;
  for (int i = 0; i < 40; ++i) {
    const std::string comma = i > 0 ? "," : "", number = std::to_string(i);
    images += comma + R"({"uri":")" + (i % 2 ? "a.png" : "./a.png") + R"("})";
    textures += comma + R"({"source":)" + number + "}";
    materials += comma + R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + number +
                 R"(}},"normalTexture":{"index":)" + number + "}}";
  }
  d.extra =
      R"(,"images":[)" + images + R"(],"textures":[)" + textures + R"(],"materials":[)" + materials + "]";
  Diagnostics warnings;
  const Scene scene = loadGltf(folder.write("model.gltf", d.json()), warnings);
  EXPECT_EQ(scene.textures.size(), 2u);  // as colours and as data
  EXPECT_EQ(scene.textures[0].rgba, scene.textures[1].rgba);
  EXPECT_NE(scene.textures[0].srgb, scene.textures[1].srgb);
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
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("NORMAL"), HasSubstr("VEC3"), HasSubstr("flat-shaded")));
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
  EXPECT_THAT(warningsOfText(d.json()), AllOf(HasSubstr("images[0].bufferView"), HasSubstr("index 5")));
}

TEST(GltfHostile, ImageThatIsNoImage) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra =
      R"(,"images":[{"name":"noise","uri":"data:image/png;base64,AAECAwQFBgc="}],"textures":[{"source":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("model.gltf"), HasSubstr("noise"), HasSubstr("without its baseColorTexture")));
}

TEST(GltfHostile, MissingTexturesAreLeftOut) {
  TriangleDocument d;
  d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
  d.extra = R"(,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],
      "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("gone.png"), HasSubstr("missing"), HasSubstr("without its baseColorTexture")));
  d.extra =
      R"(,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_FALSE(loadText(folder, d.json(), warnings).materials[0].normalTexture);
  EXPECT_THAT(warnings.format(),
              AllOf(HasSubstr("normalTexture"), HasSubstr("gone.png"), HasSubstr("missing")));
}

TEST(GltfHostile, MaterialsThatCannotBe) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"("pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":9}})",
       "metallicRoughnessTexture.index"},
      {R"("normalTexture":{"index":0})", "normalTexture.index"},
      {R"("normalTexture":{"index":0,"texCoord":-1})", "normalTexture"},
      {R"("extensions":{"KHR_materials_ior":{"ior":0.5}})", "KHR_materials_ior.ior"},
      {R"("extensions":{"KHR_materials_ior":{"ior":"glass"}})", "KHR_materials_ior"},
      {R"("extensions":{"KHR_materials_ior":{"ior":1e39}})", "not a finite number"},
      {R"("extensions":{"KHR_materials_specular":{"specularColorFactor":[1,1]}})", "specularColorFactor"},
      {R"("extensions":{"KHR_materials_specular":{"specularColorFactor":[1,1,1e39]}})",
       "not a finite number"},
      {R"("extensions":{"KHR_materials_specular":{"specularTexture":{"index":3}}})", "specularTexture.index"},
      {R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":[]}})", "clearcoatFactor"},
      {R"("extensions":{"KHR_materials_clearcoat":[]})", "KHR_materials_clearcoat"},
      {R"("extensions":{"KHR_materials_transmission":{"transmissionTexture":0}})", "transmissionTexture"},
      {R"("alphaMode":"GLASS")", "alphaMode"},
      {R"("alphaCutoff":-1)", "alphaCutoff"},
      {R"("doubleSided":1)", "doubleSided"},
      {R"("emissiveFactor":[1e39,0,0])", "not a finite number"},
      {R"("emissiveFactor":"red")", "emissiveFactor"},
      {R"("extensions":[])", "materials[0].extensions"},
      {R"("pbrMetallicRoughness":0.5)", "pbrMetallicRoughness"},
      {R"("name":7)", "materials[0].name"}};
  for (const auto& [material, message] : wrong) {
    TriangleDocument d;
    d.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    d.extra = std::string(R"(,"materials":[{)") + material + "}]";
    EXPECT_THAT(warningsOfText(d.json()), AllOf(HasSubstr("model.gltf"), HasSubstr(message))) << material;
  }
}

TEST(GltfHostile, ExtensionsAndVersions) {
  TriangleDocument d;
  d.extra = R"(,"extensionsRequired":["KHR_texture_basisu","EXT_other"])";
  EXPECT_THAT(errorOfText(d.json()), AllOf(HasSubstr("KHR_texture_basisu"), HasSubstr("EXT_other")));
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

// A light with a mistake shines without it, or is left out.
TEST(GltfHostile, ALightOrSpotThatCannotBe) {
  TriangleDocument d;
  d.nodes = R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}])";
  const auto with = [&](const std::string& lights, size_t expected) {
    d.extra = R"(,"extensions":{"KHR_lights_punctual":{"lights":[)" + lights + "]}}";
    TemporaryFolder folder;
    Diagnostics warnings;
    const Scene s = loadText(folder, d.json(), warnings);
    EXPECT_EQ(s.lights.size(), expected) << lights;
    EXPECT_EQ(s.nodes[0].light != kNoIndex, expected > 0) << lights;
    const float inner = s.lights.empty() ? 0 : s.lights[0].innerConeAngle,
                outer = s.lights.empty() ? 1 : s.lights[0].outerConeAngle;
    EXPECT_TRUE(inner <= outer && outer <= 1.5707964f) << lights;
    return warnings.format();
  };
  EXPECT_THAT(with(R"({"type":"spot"})", 1), HasSubstr("`spot` is missing"));
  for (const char* cone : {R"("innerConeAngle":0.9)", R"("innerConeAngle":0.3,"outerConeAngle":0.3)",
                           R"("innerConeAngle":0,"outerConeAngle":0)", R"("innerConeAngle":3)"})
    EXPECT_THAT(with(R"({"type":"spot","spot":{)" + std::string(cone) + "}}", 1),
                AllOf(HasSubstr("lights[0].spot"), HasSubstr("innerConeAngle"), HasSubstr("hard")))
        << cone;
  EXPECT_THAT(with(R"({"type":"spot","spot":{"outerConeAngle":2}})", 1), HasSubstr("exceeds a right angle"));
  EXPECT_THAT(with(R"({"type":"spot","spot":{"outerConeAngle":1.5707963267948966}})", 1),
              testing::Not(HasSubstr("outerConeAngle")));
  EXPECT_THAT(with(R"({"type":"laser"})", 0), AllOf(HasSubstr("laser"), HasSubstr("the light is left out")));
  EXPECT_THAT(with(R"({"type":"point","intensity":-1})", 0), HasSubstr("lights[0].intensity"));
  EXPECT_THAT(with(R"({"type":"point","color":[1]})", 1), HasSubstr("lights[0].color"));
  EXPECT_THAT(with(R"({"type":"point","range":-2})", 1), HasSubstr("lights[0].range"));
  EXPECT_THAT(with("", 0), HasSubstr("0 lights"));
}

// Cameras, skins and the like are left out one by one.
TEST(GltfHostile, DetailsThatCannotBeCostOnlyThemselves) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"(,"cameras":[{"type":"perspective"}])", "cameras[0]"},
      {R"(,"cameras":[{"type":"fisheye"}])", "fisheye"},
      {R"(,"cameras":[{"type":"perspective","perspective":{"yfov":-1}}])", "yfov"},
      {R"(,"cameras":[])", "nodes[0].camera"},
      {R"(,"skins":[{"joints":[]}])", "skins[0]"},
      {R"(,"skins":[{"joints":[7]}])", "index 7"},
      {R"(,"skins":[{"joints":[0],"inverseBindMatrices":9}])", "inverseBindMatrices"},
      {R"(,"scene":4)", "the first scene is shown"},
      {R"(,"samplers":[{"magFilter":1,"wrapS":2}])", "samplers[0].wrapS"},
      {R"(,"textures":[{"source":3}])", "textures[0].source"},
      {R"(,"textures":[{"sampler":"one"}])", "textures[0].sampler"},
      {R"(,"images":[{}])", "neither uri nor bufferView"},
      {R"(,"extensions":{"KHR_lights_punctual":{"lights":{}}})", "the lights are left out"},
      {R"(,"animations":[{"channels":[],"samplers":[]}])", "animations[0]"}};
  for (const auto& [part, message] : wrong) {
    TriangleDocument d;
    d.nodes = R"([{"mesh":0,"camera":0,"skin":0,"weights":[1]}])";
    d.extra = part;
    std::string text = d.json();
    if (std::string_view(part).starts_with(R"(,"scene":)")) text.replace(text.find(R"("scene":0,)"), 10, "");
    EXPECT_THAT(warningsOfText(text), HasSubstr(message)) << part;
  }
  TriangleDocument d;
  d.primitive =
      R"({"attributes":{"POSITION":0},"mode":9},{"attributes":{"POSITION":0},"indices":1,"material":5})";
  EXPECT_THAT(warningsOfText(d.json()),
              AllOf(HasSubstr("primitives[0].mode"), HasSubstr("primitives[1].material")));
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

// With every byte of a small file changed in three ways, the result is an error or a scene and nothing else.
TEST(GltfHostile, EveryByteChanged) {
  const std::string good = TriangleDocument{}.glb();
  TemporaryFolder folder;
  int loaded = 0, refused = 0;
  for (size_t i = 0; i < good.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff})
      (loadsChanged(folder, good, i, change) ? loaded : refused) += 1;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(loaded, 10);
}

}  // namespace
}  // namespace fovea::scene
