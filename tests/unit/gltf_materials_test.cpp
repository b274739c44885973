// Tests what the glTF loader reads of materials beyond their diffuse part, and the attributes that these need.
#include <gmock/gmock.h>

#include <cmath>

#include "framework/scene/scene.h"
#include "framework/scene/tables/tangents.h"
#include "passes/path-trace/materials.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::loadText;
using test::TemporaryFolder;
using test::TriangleDocument;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A 2x1 PNG of RGBA bytes (10, 20, 30, 255) and (200, 150, 100, 50).
constexpr const char* kImage =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR42mPgEpH7f2JaihEADHADMAAn+iUAAAAASUVORK5CYII=";

// One triangle with attributes besides its positions, each given as floats.
struct Attribute {
  const char* name;
  const char* type;
  std::vector<float> values;
};
TriangleDocument document(const std::string& material, const std::vector<Attribute>& attributes = {}) {
  TriangleDocument d;
  std::string list = R"("POSITION":0)", accessors, views;
  int accessor = 2;
  for (const Attribute& a : attributes) {
    const size_t begin = d.bytes.size();
    test::appendBytes<float>(d.bytes, a.values);
    list += ",\"" + std::string(a.name) + "\":" + std::to_string(accessor);
    const size_t components = std::string(a.type) == "VEC2" ? 2 : std::string(a.type) == "VEC3" ? 3 : 4;
    accessors += R"(,{"bufferView":)" + std::to_string(accessor) + R"(,"componentType":5126,"count":)" +
                 std::to_string(a.values.size() / components) + R"(,"type":")" + a.type + "\"}";
    views += R"(,{"buffer":0,"byteOffset":)" + std::to_string(begin) + R"(,"byteLength":)" +
             std::to_string(d.bytes.size() - begin) + "}";
    ++accessor;
  }
  d.primitive = R"({"attributes":{)" + list + R"(},"indices":1,"material":0})";
  d.accessors.insert(d.accessors.size() - 1, accessors);
  d.views.insert(d.views.size() - 1, views);
  d.extra = std::string(R"(,"images":[{"uri":")") + kImage +
            R"("}],"textures":[{"source":0}],"materials":[{)" + material + "}]";
  return d;
}

const std::vector<float> kUvs = {0, 1, 1, 1, 0, 0}, kOtherUvs = {0.75f, 0.5f, 0.75f, 0.5f, 0.75f, 0.5f},
                         kNormals = {0, 0, 1, 0, 0, 1, 0, 0, 1};

class GltfMaterials : public testing::Test {
 protected:
  Scene load(const TriangleDocument& d) {
    warnings = {};
    return loadText(folder, d.json(), warnings);
  }
  Scene load(const std::string& material, const std::vector<Attribute>& attributes = {}) {
    return load(document(material, attributes));
  }
  TemporaryFolder folder;
  Diagnostics warnings;
};

TEST_F(GltfMaterials, FactorsAndExtensions) {
  const Scene s = load(R"("pbrMetallicRoughness":{"metallicFactor":0.25,"roughnessFactor":0.75},"extensions":{
      "KHR_materials_ior":{"ior":1.33},
      "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[2,0.5,0]},
      "KHR_materials_transmission":{"transmissionFactor":0.9},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.3,"clearcoatRoughnessFactor":0.1},
      "KHR_materials_unlit":{}})");
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
  const Material& m = s.materials.at(0);
  EXPECT_EQ(m.metallic, 0.25f);
  EXPECT_EQ(m.meanMetallic(), 0.25f);
  EXPECT_EQ(m.roughness, 0.75f);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specular, 0.5f);
  EXPECT_EQ(m.specularColor, glm::vec3(2, 0.5f, 0));
  EXPECT_EQ(m.transmission, 0.9f);
  EXPECT_EQ(m.clearcoat, 0.3f);
  EXPECT_EQ(m.clearcoatRoughness, 0.1f);
  EXPECT_TRUE(m.unlit);
}

// glTF's defaults, of which a diffuse material takes over only what the file says of metal.
TEST_F(GltfMaterials, DefaultsAreThoseOfGltf) {
  const Scene s = load("");
  const Material& m = s.materials.at(0);
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.meanMetallic(), 0);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.transmission, 0);
  EXPECT_EQ(m.clearcoat, 0);
  EXPECT_FALSE(m.unlit);
}

TEST_F(GltfMaterials, OneImageAsColourAndAsDataGivesTwoTextures) {
  const Scene s = load(R"("normalTexture":{"index":0,"scale":0.5},
      "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}})",
                       {{"TEXCOORD_0", "VEC2", kUvs}});
  ASSERT_EQ(s.textures.size(), 2u);
  const Material& m = s.materials[0];
  EXPECT_TRUE(s.textures[m.baseColorTexture.texture].srgb);
  EXPECT_FALSE(s.textures[m.normalTexture.texture].srgb);
  EXPECT_EQ(m.normalTexture.texture, m.metallicRoughnessTexture.texture);
  EXPECT_EQ(m.normalScale, 0.5f);
  EXPECT_FLOAT_EQ(m.metallicMean, (30 + 100) / 2 / 255.0f);
}

TEST_F(GltfMaterials, EachTextureHasItsCoordinatesAndTransform) {
  const Scene s = load(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0},
      "metallicRoughnessTexture":{"index":0,"texCoord":1,
        "extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,1]}}}})",
                       {{"TEXCOORD_0", "VEC2", kUvs}, {"TEXCOORD_1", "VEC2", kOtherUvs}});
  EXPECT_TRUE(warnings.list().empty()) << warnings.format();
  const Material& m = s.materials[0];
  EXPECT_EQ(m.baseColorTexture.set, 0u);
  EXPECT_EQ(m.metallicRoughnessTexture.set, 1u);
  EXPECT_EQ(m.metallicRoughnessTexture.transform, glm::mat3x2(2, 0, 0, 1, 0.5f, 0));
  const Geometry g = flatten(s);
  // u = 0.75 becomes 2: between the last texel and the first.
  const path_trace::SurfacePoint p = path_trace::Materials(s, g).at({0, 1, 0.25f, 0.25f});
  EXPECT_NEAR(p.bsdf.roughness, (20 + 150) / 2 / 255.0f, 1e-5f);
  EXPECT_NEAR(p.bsdf.metallic, (30 + 100) / 2 / 255.0f, 1e-5f);
}

TEST_F(GltfMaterials, AThirdSetOfCoordinatesAndAMissingOneAreNamed) {
  load(R"("normalTexture":{"index":0,"texCoord":1},"pbrMetallicRoughness":{"baseColorTexture":{"index":0},
      "metallicRoughnessTexture":{"index":0,"texCoord":2}})",
       {{"TEXCOORD_0", "VEC2", kUvs}});
  EXPECT_THAT(warnings.format(),
              AllOf(HasSubstr("normalTexture uses a third set"), HasSubstr("has no TEXCOORD_2")));
}

TEST_F(GltfMaterials, WhatIsLeftOutIsNamedOnce) {
  TriangleDocument d = document(R"("name":"velvet","extensions":{"KHR_materials_sheen":{},
      "KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":0}}}},{"extensions":{"KHR_materials_sheen":{}})");
  load(d);
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("materials[0] `velvet`"), HasSubstr("KHR_materials_sheen"),
                                       HasSubstr("clearcoatNormalTexture"), Not(HasSubstr("materials[1]"))));
}

TEST_F(GltfMaterials, VertexColoursMultiplyTheBaseColour) {
  const Scene s = load(R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1]})",
                       {{"COLOR_0", "VEC3", {1, 0, 0, 1, 0.5f, 0, 1, 0, NAN}}});
  EXPECT_THAT(warnings.format(), HasSubstr("COLOR_0"));
  const Geometry g = flatten(s);
  ASSERT_EQ(g.colors.size(), 3u);
  EXPECT_EQ(g.colors[2], glm::vec4(1, 0, 1, 1));  // what is not finite reads as 1
  const path_trace::SurfacePoint p = path_trace::Materials(s, g).at({0, 1, 1, 0});
  EXPECT_LT(glm::distance(p.bsdf.baseColor, glm::vec3(0.5f, 0.5f, 0)), 1e-6f);
}

TEST_F(GltfMaterials, AttributesOfAnotherLengthAreIgnored) {
  const Scene s = load(R"("normalTexture":{"index":0})", {{"NORMAL", "VEC3", kNormals},
                                                          {"TEXCOORD_0", "VEC2", kUvs},
                                                          {"COLOR_0", "VEC3", {1, 1, 1}},
                                                          {"TANGENT", "VEC4", {1, 0, 0, 1}}});
  EXPECT_THAT(warnings.format(), AllOf(HasSubstr("COLOR_0"), HasSubstr("TANGENT"), HasSubstr("is ignored")));
  EXPECT_TRUE(flatten(s).colors.empty());
}

// The first texel leans the normal towards -u and, because green points up in the texture, to where v grows.
TEST_F(GltfMaterials, NormalMapFollowsTheTextureCoordinates) {
  const std::vector<Attribute> attributes = {{"NORMAL", "VEC3", kNormals}, {"TEXCOORD_0", "VEC2", kUvs}};
  const Scene s = load(
      R"("normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[0,0]}}})", attributes);
  const Geometry g = flatten(s);
  const path_trace::SurfacePoint p = path_trace::Materials(s, g).at({0, 1, 0.2f, 0.2f});
  // u runs along x and v along -y; the texel between both, with weights 1/2.
  const glm::vec3 texel = glm::vec3(105, 85, 65) * 2.0f / 255.0f - 1.0f;
  EXPECT_LT(glm::distance(p.normal, glm::normalize(texel)), 1e-5f);
  EXPECT_EQ(p.face, glm::vec3(0, 0, 1));
}

TEST_F(GltfMaterials, TangentsOfTheModelDecide) {
  const Scene s =
      load(R"("normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[0,0]}}})",
           {{"NORMAL", "VEC3", kNormals},
            {"TEXCOORD_0", "VEC2", kUvs},
            {"TANGENT", "VEC4", {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}}});
  const Geometry g = flatten(s);
  const path_trace::SurfacePoint p = path_trace::Materials(s, g).at({0, 1, 0.2f, 0.2f});
  const glm::vec3 texel = glm::vec3(105, 85, 65) * 2.0f / 255.0f - 1.0f;
  // Tangent y, bitangent -cross(z, y) = x.
  EXPECT_LT(glm::distance(p.normal, glm::normalize(glm::vec3(texel.y, texel.x, texel.z))), 1e-5f);
}

// With every byte of the text changed in two ways, the result is an error or a scene that can be looked up.
TEST_F(GltfMaterials, EveryByteChanged) {
  const std::string good =
      document(R"("normalTexture":{"index":0,"scale":2},"emissiveFactor":[1,1,1],"extensions":{
      "KHR_materials_ior":{"ior":1.4},"KHR_materials_specular":{"specularColorTexture":{"index":0}},
      "KHR_materials_clearcoat":{"clearcoatFactor":1}},"pbrMetallicRoughness":{"metallicFactor":0.5,
      "metallicRoughnessTexture":{"index":0,"texCoord":1}})",
               {{"NORMAL", "VEC3", kNormals},
                {"TEXCOORD_0", "VEC2", kUvs},
                {"TEXCOORD_1", "VEC2", kOtherUvs},
                {"COLOR_0", "VEC4", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}},
                {"TANGENT", "VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}}})
          .glb();
  int loaded = 0, refused = 0;
  for (size_t i = 12; i < good.size(); ++i)
    for (const int change : {0x01, 0x7f}) {
      std::string bad = good;
      bad[i] = char(bad[i] ^ change);
      Diagnostics messages;
      try {
        const Scene s = loadText(folder, bad, messages, "model.glb");
        const Geometry g = flatten(s);
        ++loaded;
        if (g.triangles.empty()) continue;
        const path_trace::SurfacePoint p = path_trace::Materials(s, g).at({0, 1, 0.3f, 0.3f});
        ASSERT_NEAR(glm::length(p.normal), 1, 1e-4f) << "byte " << i;
        ASSERT_TRUE(p.bsdf.roughness >= 0 && p.bsdf.roughness <= 1 && p.bsdf.metallic <= 1) << "byte " << i;
        for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(p.emission[c] + p.bsdf.baseColor[c]));
      } catch (const Error& e) {
        EXPECT_EQ(int(e.code()), int(ExitCode::BadInput)) << "byte " << i << ": " << e.what();
        ++refused;
      }
    }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(loaded, 100);
}

// ---- Tangents -------------------------------------------------------------------------------------------------

// A ring of triangles around the z axis, u along the angle: the tangents are those of a circle, whatever the position
// of the seam, and the same on both sides of every edge.
TEST(Tangents, AroundACylinder) {
  Primitive p;
  constexpr uint32_t kSides = 12;
  for (uint32_t i = 0; i <= kSides; ++i)
    for (uint32_t k = 0; k < 2; ++k) {
      const float angle = glm::two_pi<float>() * float(i % kSides) / float(kSides);
      p.positions.push_back({std::cos(angle), std::sin(angle), float(k)});
      p.normals.push_back({std::cos(angle), std::sin(angle), 0});
      p.uvs.push_back({float(i) / float(kSides), 1 - float(k)});
    }
  for (uint32_t i = 0; i < kSides; ++i)
    for (const uint32_t v : {0u, 2u, 1u, 1u, 2u, 3u}) p.indices.push_back(2 * i + v);
  const std::vector<TriangleTangents> tangents = triangleTangents(p, 0);
  ASSERT_EQ(tangents.size(), 2 * kSides);
  for (size_t t = 0; t < tangents.size(); ++t) {
    EXPECT_EQ(tangents[t].bitangentSign, 1);
    const glm::vec3 a = p.positions[p.indices[3 * t]], b = p.positions[p.indices[3 * t + 1]] - a,
                    c = p.positions[p.indices[3 * t + 2]] - a;
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = p.indices[3 * t + size_t(k)];
      if (v < 2 || v >= 2 * kSides) continue;  // at the seam only the triangles of one side count
      const glm::vec3 n = p.normals[v], want(-n.y, n.x, 0);
      EXPECT_LT(glm::distance(tangentAt(tangents[t], b, c, k == 1, k == 2), want), 1e-5f);
    }
  }
}

// Scaled, sheared and turned inside out, tangents go where the directions of the surface go.
TEST(Tangents, FollowTheTriangle) {
  Primitive p;
  p.positions = {{0, 0, 0}, {2, 0, 0}, {0.5f, 1, 0.2f}};
  p.normals.assign(3, glm::normalize(glm::cross(p.positions[1], p.positions[2])));
  p.uvs = {{0.1f, 0.9f}, {0.7f, 0.8f}, {0.3f, 0.2f}};
  p.indices = {0, 1, 2};
  const TriangleTangents rest = triangleTangents(p, 0)[0];
  const glm::vec3 before = tangentAt(rest, p.positions[1], p.positions[2], 0.3f, 0.3f);
  const glm::mat3 m(-2, 0.3f, 0, 0.5f, 1, 0.1f, 0, 0.7f, 3);  // determinant below 0
  ASSERT_LT(glm::determinant(m), 0);
  const glm::vec3 after = tangentAt(turned(rest), m * p.positions[2], m * p.positions[1], 0.3f, 0.3f);
  EXPECT_LT(glm::distance(glm::normalize(m * before), glm::normalize(after)), 1e-5f);
  EXPECT_EQ(turned(rest).bitangentSign, -rest.bitangentSign);
}

TEST(Tangents, WithoutTextureCoordinatesThereAreNone) {
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.uvs.assign(3, {0, 0});
  p.indices = {0, 1, 2};
  const TriangleTangents tangents = triangleTangents(p, 0)[0];
  for (const glm::vec3& c : tangents.corners) EXPECT_EQ(c, glm::vec3(0));
}

}  // namespace
}  // namespace fovea::scene
