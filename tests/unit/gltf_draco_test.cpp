// KHR_draco_mesh_compression: what Draco's encoder writes loads as the model did before, and damaged data is refused.
#include <draco/compression/encode.h>
#include <draco/core/varint_encoding.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "compressed_support.h"

namespace fovea::scene {
namespace {

using test::DocumentBuilder;
using test::errorOfText;
using test::loadsChanged;
using test::loadText;
using test::primitiveOf;
using test::TemporaryFolder;
using test::TriangleDocument;
using test::WavyGrid;
using testing::AllOf;
using testing::HasSubstr;

int addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, const std::vector<float>& values,
                 int components) {
  draco::GeometryAttribute form;
  form.Init(type, nullptr, uint8_t(components), draco::DT_FLOAT32, false, 4 * components, 0);
  const int id = mesh.AddAttribute(form, true, mesh.num_points());
  for (uint32_t i = 0; i < mesh.num_points(); ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * uint32_t(components)]);
  return id;
}

// The attributes have the ids 0 (positions), 1 (normals) and 2 (texture coordinates).
std::string encoded(const WavyGrid& grid, draco::MeshEncoderMethod method, bool quantized) {
  draco::Mesh mesh;
  mesh.set_num_points(uint32_t(grid.vertices()));
  addAttribute(mesh, draco::GeometryAttribute::POSITION, grid.positions, 3);
  addAttribute(mesh, draco::GeometryAttribute::NORMAL, grid.normals, 3);
  addAttribute(mesh, draco::GeometryAttribute::TEX_COORD, grid.uvs, 2);
  for (size_t i = 0; i < grid.indices.size(); i += 3)
    mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                  draco::PointIndex(grid.indices[i + 2])});
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  if (quantized) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
  }
  draco::EncoderBuffer out;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &out).ok());
  return {out.data(), out.size()};
}

constexpr char kRequired[] =
    R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])";

// With accessors 0 to 3: positions, normals, texture coordinates and indices.
TriangleDocument dracoDocument(const std::string& stream, size_t vertices, size_t indices) {
  DocumentBuilder b;
  b.view(0, b.append(stream.data(), stream.size()), stream.size());
  b.accessor(-1, 5126, vertices, "VEC3");
  b.accessor(-1, 5126, vertices, "VEC3");
  b.accessor(-1, 5126, vertices, "VEC2");
  b.accessor(-1, 5125, indices, "SCALAR");
  TriangleDocument d = b.document(
      R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"extensions":{"KHR_draco_mesh_compression":
          {"bufferView":0,"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}}})");
  d.extra = kRequired;
  return d;
}

TriangleDocument dracoDocument(const WavyGrid& grid, draco::MeshEncoderMethod method,
                               bool quantized = false) {
  return dracoDocument(encoded(grid, method, quantized), grid.vertices(), grid.indices.size());
}

TEST(GltfDraco, SequentialDataEqualsTheUncompressedModel) {
  const WavyGrid grid(20);
  const Primitive plain = primitiveOf(plainDocument(grid));
  for (const bool binary : {false, true}) {
    const Primitive p = primitiveOf(dracoDocument(grid, draco::MESH_SEQUENTIAL_ENCODING), binary);
    EXPECT_EQ(p.positions, plain.positions);
    EXPECT_EQ(p.normals, plain.normals);
    EXPECT_EQ(p.uvs, plain.uvs);
    EXPECT_EQ(p.indices, plain.indices);
  }
}

struct Corner {
  glm::vec3 position, normal;
  glm::vec2 uv;
};

// The corners of each triangle, from the one nearest to the origin; the triangles by place. Edgebreaker changes the order
// of vertices and triangles.
std::vector<std::array<Corner, 3>> sortedTriangles(const Primitive& p) {
  std::vector<std::array<Corner, 3>> list;
  for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    std::array<Corner, 3> t;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = p.indices[i + k];
      t[k] = {p.positions[v], p.normals[v], p.uvs[v]};
    }
    const auto near = [](const Corner& a, const Corner& b) {
      return a.position.x + 1.01f * a.position.z < b.position.x + 1.01f * b.position.z;
    };
    std::rotate(t.begin(), std::min_element(t.begin(), t.end(), near), t.end());
    list.push_back(t);
  }
  // Centres of triangles are at least a third of a quad apart in x or z.
  const auto key = [](const std::array<Corner, 3>& t) {
    const glm::vec3 sum = t[0].position + t[1].position + t[2].position;
    return std::pair(std::lround(20 * sum.x), std::lround(20 * sum.z));
  };
  std::sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return list;
}

TEST(GltfDraco, QuantizedEdgebreakerDataIsTheModelWithinHalfAStep) {
  const WavyGrid grid(20);
  const auto plain = sortedTriangles(primitiveOf(plainDocument(grid)));
  for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING})
    for (const bool quantized : {false, true}) {
      const auto decoded = sortedTriangles(primitiveOf(dracoDocument(grid, method, quantized)));
      ASSERT_EQ(decoded.size(), plain.size());
      for (size_t i = 0; i < plain.size(); ++i)
        for (size_t k = 0; k < 3; ++k) {
          const Corner &a = decoded[i][k], &b = plain[i][k];
          EXPECT_LT(glm::distance(a.position, b.position), quantized ? 1e-4f : 1e-7f)
              << i;  // 2^-14 of the range 1
          EXPECT_LT(glm::distance(a.normal, b.normal), quantized ? 4e-3f : 1e-6f) << i;
          EXPECT_LT(glm::distance(a.uv, b.uv), quantized ? 4e-4f : 1e-7f) << i;
        }
    }
}

TEST(GltfDraco, TwoPrimitivesMayShareTheirAccessors) {
  // Two meshes with as many vertices and triangles as each other, and the same accessors.
  const WavyGrid first(6);
  WavyGrid second(6);
  for (float& x : second.positions) x += 5;
  const std::string a = encoded(first, draco::MESH_SEQUENTIAL_ENCODING, false);
  const std::string b = encoded(second, draco::MESH_SEQUENTIAL_ENCODING, false);
  TriangleDocument d = dracoDocument(a + std::string((4 - a.size() % 4) % 4, '\0') + b, first.vertices(),
                                     first.indices.size());
  const size_t start = (a.size() + 3) / 4 * 4;
  d.views = R"([{"buffer":0,"byteLength":)" + std::to_string(a.size()) + R"(},{"buffer":0,"byteOffset":)" +
            std::to_string(start) + R"(,"byteLength":)" + std::to_string(b.size()) + "}]";
  std::string other = d.primitive;
  other.replace(other.find(R"("bufferView":0)"), 14, R"("bufferView":1)");
  d.primitive += "," + other;
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  ASSERT_EQ(s.meshes[0].primitives.size(), 2u);
  EXPECT_EQ(s.meshes[0].primitives[0].positions[0], glm::vec3(0));
  EXPECT_EQ(s.meshes[0].primitives[1].positions[0], glm::vec3(5));
}

TEST(GltfDraco, StripsAreDecodedToTriangles) {
  const WavyGrid grid(6);
  TriangleDocument d =
      dracoDocument(encoded(grid, draco::MESH_SEQUENTIAL_ENCODING, false), grid.vertices(), 40);
  d.primitive.insert(1, R"("mode":5,)");
  EXPECT_EQ(primitiveOf(d).indices, grid.indices);
}

TEST(GltfDraco, MoreElementsThanAnAccessorOfZerosMayHave) {
  const WavyGrid grid(850);  // 4.3 million indices
  const std::string stream = encoded(grid, draco::MESH_EDGEBREAKER_ENCODING, true);
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, dracoDocument(stream, grid.vertices(), grid.indices.size()).glb(),
                           warnings, "model.glb");
  EXPECT_EQ(s.meshes[0].primitives[0].indices.size(), grid.indices.size());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(GltfDraco, WhatCannotBeIsRefusedWithItsPlace) {
  const WavyGrid grid(6);
  const TriangleDocument good = dracoDocument(grid, draco::MESH_EDGEBREAKER_ENCODING);
  ASSERT_EQ(errorOfText(good.json()), "");
  struct Case {
    std::string TriangleDocument::*part;
    const char *from, *to, *message;
  };
  for (const Case& c : {
           Case{&TriangleDocument::primitive, R"("TEXCOORD_0":2}}})", R"("TEXCOORD_0":9}}})",
                "no attribute 9"},
           {&TriangleDocument::primitive, R"("TEXCOORD_0":2}}})", R"("TEXCOORD_0":1}}})", "has 3 components"},
           {&TriangleDocument::primitive, R"("TEXCOORD_0":2}}})", R"("TEXCOORD_0":-1}}})", "TEXCOORD_0"},
           {&TriangleDocument::primitive, R"("TEXCOORD_0":2}}})", R"("COLOR_0":2}}})",
            "no attribute `COLOR_0`"},
           {&TriangleDocument::primitive, R"("bufferView":0)", R"("bufferView":3)", "index 3"},
           {&TriangleDocument::primitive, R"("bufferView":0,)", "", "`bufferView` is missing"},
           {&TriangleDocument::primitive, R"("indices":3)", R"("indices":3,"mode":1)",
            "mode 1 cannot be compressed"},
           {&TriangleDocument::accessors, R"("count":49)", R"("count":48)", "48 elements, the data 49"},
           {&TriangleDocument::accessors, R"("count":49)", R"("count":2147483647)", "2147483647 elements"},
           {&TriangleDocument::accessors, R"("count":216)", R"("count":213)", "213 elements, the data 216"},
           {&TriangleDocument::accessors, R"("VEC2")", R"("MAT3")", "another type"},
       }) {
    TriangleDocument bad = good;
    bad.*c.part = replaced(bad.*c.part, c.from, c.to);
    EXPECT_THAT(errorOfText(bad.json()),
                AllOf(HasSubstr("model.gltf:"), HasSubstr("primitives[0]"), HasSubstr(c.message)))
        << c.from << " -> " << c.to;
  }
  EXPECT_THAT(errorOfText(dracoDocument("no Draco data at all", 49, 216).json()),
              AllOf(HasSubstr("bufferViews[0]"), HasSubstr("is no Draco data")));
}

// A header, and counts behind it that would ask for gigabytes.
TEST(GltfDraco, AFewBytesCannotClaimMuchMemory) {
  for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const std::string good = encoded(WavyGrid(6), method, false);
    draco::EncoderBuffer counts;
    draco::EncodeVarint(uint32_t(1400000000), &counts);
    draco::EncodeVarint(uint32_t(1400000000), &counts);
    const size_t header = method == draco::MESH_SEQUENTIAL_ENCODING ? 11 : 12;
    const std::string bad =
        good.substr(0, header) + std::string(counts.data(), counts.size()) + good.substr(header);
    EXPECT_THAT(errorOfText(dracoDocument(bad, 1400000000, 216).json()),
                AllOf(HasSubstr("model.gltf:"), HasSubstr("cannot hold the 1400000000 triangles")));
  }
}

TEST(GltfDraco, StreamsThatAreCutShort) {
  const WavyGrid grid(6);
  for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const std::string good = encoded(grid, method, true);
    for (size_t size = 1; size < good.size(); size += 7)
      EXPECT_THAT(
          errorOfText(dracoDocument(good.substr(0, size), grid.vertices(), grid.indices.size()).json()),
          AllOf(HasSubstr("model.gltf:"), HasSubstr("KHR_draco_mesh_compression")))
          << size;
  }
}

TEST(GltfDraco, EveryByteChanged) {
  const WavyGrid grid(3);
  for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING})
    for (const bool quantized : {false, true}) {
      const std::string good = dracoDocument(grid, method, quantized).glb();
      TemporaryFolder folder;
      int loaded = 0, refused = 0;
      for (size_t i = 0; i < good.size(); ++i)
        for (const int change : {0x01, 0x80, 0xff})
          (loadsChanged(folder, good, i, change) ? loaded : refused) += 1;
      EXPECT_GT(refused, 1000);
      EXPECT_GT(loaded, 100);
    }
}

}  // namespace
}  // namespace fovea::scene
