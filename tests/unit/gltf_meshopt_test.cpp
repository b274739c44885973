// EXT_meshopt_compression: what meshoptimizer's encoders write loads as the model did before, and damaged data is refused.
#include <gmock/gmock.h>
#include <meshoptimizer.h>

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
using test::warningsOfText;
using test::WavyGrid;
using testing::AllOf;
using testing::HasSubstr;

using Bytes = std::vector<unsigned char>;

Bytes encodedVertices(const void* vertices, size_t count, size_t stride) {
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices, count, stride));
  return out;
}

Bytes encodedTriangles(const std::vector<uint32_t>& indices, size_t vertices) {
  Bytes out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  return out;
}

Bytes encodedSequence(const std::vector<uint32_t>& indices, size_t vertices) {
  Bytes out(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
  return out;
}

// Writes models whose views lie compressed in buffer 0 and have their places in buffer 1, which has no data.
class CompressedBuilder : public DocumentBuilder {
 public:
  int compressed(const Bytes& stream, size_t count, size_t stride, const std::string& mode,
                 const std::string& filter = "NONE") {
    const size_t place = reserved_;
    reserved_ += (count * stride + 3) / 4 * 4;
    return view(1, place, count * stride,
                R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
                    std::to_string(append(stream.data(), stream.size())) + R"(,"byteLength":)" +
                    std::to_string(stream.size()) + R"(,"byteStride":)" + std::to_string(stride) +
                    R"(,"count":)" + std::to_string(count) + R"(,"mode":")" + mode + R"(","filter":")" +
                    filter + R"("}})");
  }

  TriangleDocument compressedDocument(const std::string& primitive) const {
    TriangleDocument d = document(primitive);
    d.moreBuffers = R"(,{"byteLength":)" + std::to_string(reserved_) +
                    R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
    d.extra =
        R"(,"extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"])";
    return d;
  }

 private:
  size_t reserved_ = 0;
};

struct Storage {
  const char* mode;
  size_t indexSize;
};

TriangleDocument compressedDocument(const WavyGrid& grid, const Storage& storage = {"TRIANGLES", 4}) {
  CompressedBuilder b;
  const size_t n = grid.vertices(), indexCount = grid.indices.size();
  const auto floats = [&](const std::vector<float>& values, size_t components) {
    return b.accessor(
        b.compressed(encodedVertices(values.data(), n, 4 * components), n, 4 * components, "ATTRIBUTES"),
        5126, n, "VEC" + std::to_string(components));
  };
  const int position = floats(grid.positions, 3), normal = floats(grid.normals, 3), uv = floats(grid.uvs, 2);
  const Bytes stream = storage.mode == std::string("TRIANGLES") ? encodedTriangles(grid.indices, n)
                                                                : encodedSequence(grid.indices, n);
  const int indices = b.accessor(b.compressed(stream, indexCount, storage.indexSize, storage.mode),
                                 storage.indexSize == 2 ? 5123 : 5125, indexCount, "SCALAR");
  return b.compressedDocument(R"({"attributes":{"POSITION":)" + std::to_string(position) + R"(,"NORMAL":)" +
                              std::to_string(normal) + R"(,"TEXCOORD_0":)" + std::to_string(uv) +
                              R"(},"indices":)" + std::to_string(indices) + "}");
}

// The encoder may begin a triangle with another of its vertices.
std::vector<std::array<uint32_t, 3>> trianglesOf(const std::vector<uint32_t>& indices) {
  std::vector<std::array<uint32_t, 3>> list;
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<uint32_t, 3> t = {indices[i], indices[i + 1], indices[i + 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    list.push_back(t);
  }
  return list;
}

TEST(GltfMeshopt, EqualsTheUncompressedModel) {
  const WavyGrid grid(20);
  const Primitive plain = primitiveOf(plainDocument(grid));
  for (const Storage& storage : {Storage{"TRIANGLES", 2}, {"TRIANGLES", 4}, {"INDICES", 2}, {"INDICES", 4}})
    for (const bool binary : {false, true}) {
      const Primitive p = primitiveOf(compressedDocument(grid, storage), binary);
      EXPECT_EQ(p.positions, plain.positions);
      EXPECT_EQ(p.normals, plain.normals);
      EXPECT_EQ(p.uvs, plain.uvs);
      EXPECT_EQ(trianglesOf(p.indices), trianglesOf(plain.indices)) << storage.mode << storage.indexSize;
    }
}

TEST(GltfMeshopt, TheFileOfAPlaceholderIsNotLookedFor) {
  TriangleDocument d = compressedDocument(WavyGrid(4));
  d.moreBuffers.insert(d.moreBuffers.find('{') + 1, R"("uri":"fallback.bin",)");
  EXPECT_EQ(errorOfText(d.json()), "");
  EXPECT_EQ(errorOfText(d.glb(), "model.glb"), "");
}

// A view may be compressed and also lie uncompressed in a buffer with data; the compressed data is read.
TEST(GltfMeshopt, APlaceholderMayHaveData) {
  TriangleDocument d = compressedDocument(WavyGrid(4));
  const size_t mark = d.moreBuffers.find(R"(,"extensions")");
  d.moreBuffers = d.moreBuffers.substr(0, mark) + R"(,"uri":"zeros.bin"})";
  TemporaryFolder folder;
  folder.write("zeros.bin", std::string(100000, '\0'));
  Diagnostics warnings;
  EXPECT_EQ(loadText(folder, d.json(), warnings).meshes[0].primitives[0].indices.size(), 6u * 16u);
}

TEST(GltfMeshopt, OctahedralNormalsWithQuantizedPositions) {
  const WavyGrid grid(20);
  const size_t n = grid.vertices();
  std::vector<float> four;  // the encoder takes a fourth component
  std::vector<int16_t> positions;
  for (size_t i = 0; i < n; ++i) {
    four.insert(four.end(), {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
    for (size_t k = 0; k < 3; ++k)
      positions.push_back(int16_t(std::lround(32767 * grid.positions[3 * i + k])));
    positions.push_back(0);
  }
  for (const size_t stride : {size_t(4), size_t(8)}) {
    const int bits = stride == 4 ? 8 : 16;
    CompressedBuilder b;
    Bytes normals(n * stride);
    meshopt_encodeFilterOct(normals.data(), n, stride, bits, four.data());
    const int normalView =
        b.compressed(encodedVertices(normals.data(), n, stride), n, stride, "ATTRIBUTES", "OCTAHEDRAL");
    const int positionView = b.compressed(encodedVertices(positions.data(), n, 8), n, 8, "ATTRIBUTES");
    const int indexView =
        b.compressed(encodedTriangles(grid.indices, n), grid.indices.size(), 4, "TRIANGLES");
    b.accessor(positionView, 5122, n, "VEC3", true);
    b.accessor(normalView, stride == 4 ? 5120 : 5122, n, "VEC3", true);
    b.accessor(indexView, 5125, grid.indices.size(), "SCALAR");
    TriangleDocument d = b.compressedDocument(R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2})");
    // An accessor is tightly packed unless its view has a stride, and here a fourth component pads it.
    size_t view = 0;
    for (const size_t s : {stride, size_t(8)}) {
      view = d.views.find(R"(,"extensions")", view);
      const std::string text = R"(,"byteStride":)" + std::to_string(s);
      d.views.insert(view, text);
      view += text.size() + 1;
    }
    const Primitive p = primitiveOf(d);
    ASSERT_EQ(p.normals.size(), n);
    for (size_t i = 0; i < n; ++i) {
      const glm::vec3 normal(grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2]);
      const glm::vec3 position(grid.positions[3 * i], grid.positions[3 * i + 1], grid.positions[3 * i + 2]);
      // Half a step in each octahedral coordinate, and half a step where the result is rounded.
      EXPECT_LT(glm::distance(p.normals[i], normal), stride == 4 ? 0.02f : 1e-4f) << i;
      EXPECT_LT(glm::distance(p.positions[i], position), 1e-4f) << i;
    }
  }
}

TEST(GltfMeshopt, ExponentialPositions) {
  const WavyGrid grid(20);
  const size_t n = grid.vertices();
  CompressedBuilder b;
  Bytes filtered(n * 12);
  meshopt_encodeFilterExp(filtered.data(), n, 12, 16, grid.positions.data());
  b.accessor(b.compressed(encodedVertices(filtered.data(), n, 12), n, 12, "ATTRIBUTES", "EXPONENTIAL"), 5126,
             n, "VEC3");
  b.accessor(b.compressed(encodedTriangles(grid.indices, n), grid.indices.size(), 4, "TRIANGLES"), 5125,
             grid.indices.size(), "SCALAR");
  const Primitive plain = primitiveOf(b.compressedDocument(R"({"attributes":{"POSITION":0},"indices":1})"));
  // Without normals each triangle has vertices of its own.
  ASSERT_EQ(plain.positions.size(), grid.indices.size());
  const auto corners = trianglesOf(grid.indices);
  for (size_t t = 0; t < corners.size(); ++t) {
    glm::vec3 mean(0), expected(0);
    for (size_t k = 0; k < 3; ++k) {
      mean += plain.positions[3 * t + k];
      const float* v = &grid.positions[3 * corners[t][k]];
      expected += glm::vec3(v[0], v[1], v[2]);
    }
    EXPECT_LT(glm::distance(mean, expected), 3 * 1e-4f) << t;  // 16 bits of mantissa
  }
}

TEST(GltfMeshopt, QuaternionsOfAnAnimation) {
  constexpr size_t kKeys = 50;
  std::vector<float> times, rotations;
  for (size_t i = 0; i < kKeys; ++i) {
    const float angle = 0.06f * float(i);
    times.push_back(float(i));
    rotations.insert(rotations.end(), {0.6f * std::sin(angle), 0, 0.8f * std::sin(angle), std::cos(angle)});
  }
  const WavyGrid grid(2);
  CompressedBuilder b;
  Bytes filtered(kKeys * 8);
  meshopt_encodeFilterQuat(filtered.data(), kKeys, 8, 12, rotations.data());
  b.accessor(b.plainView(grid.positions), 5126, grid.vertices(), "VEC3");
  b.accessor(b.plainView(grid.indices), 5125, grid.indices.size(), "SCALAR");
  b.accessor(b.compressed(encodedVertices(times.data(), kKeys, 4), kKeys, 4, "ATTRIBUTES"), 5126, kKeys,
             "SCALAR");
  b.accessor(b.compressed(encodedVertices(filtered.data(), kKeys, 8), kKeys, 8, "ATTRIBUTES", "QUATERNION"),
             5122, kKeys, "VEC4", true);
  TriangleDocument d = b.compressedDocument(R"({"attributes":{"POSITION":0},"indices":1})");
  d.extra += R"(,"animations":[{"samplers":[{"input":2,"output":3}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}]}])";
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadText(folder, d.json(), warnings);
  const AnimationChannel& channel = s.animations.at(0).channels.at(0);
  EXPECT_EQ(channel.times, times);
  ASSERT_EQ(channel.values.size(), rotations.size());
  for (size_t i = 0; i < kKeys; ++i) {
    float dot = 0;  // q and -q are the same rotation
    for (size_t k = 0; k < 4; ++k) dot += channel.values[4 * i + k] * rotations[4 * i + k];
    EXPECT_NEAR(std::abs(dot), 1, 1e-5f) << i;
  }
}

// Changes the first place of `from` behind `mark`.
std::string changed(std::string text, const std::string& mark, const std::string& from,
                    const std::string& to) {
  const size_t at = text.find(from, text.find(mark));
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(GltfMeshopt, WhatCannotBeIsRefusedWithItsPlace) {
  const std::string good = compressedDocument(WavyGrid(20)).json();
  ASSERT_EQ(errorOfText(good), "");
  const std::string mark = "EXT_meshopt_compression\":{\"buffer";
  struct Case {
    const char *from, *to, *message;
  };
  for (const Case& c : {
           Case{R"("mode":"ATTRIBUTES")", R"("mode":"INDICES")",
                "byteStride 12 is impossible in mode INDICES"},
           {R"("mode":"ATTRIBUTES")", R"("mode":"POINTS")", "POINTS"},
           {R"("mode":"ATTRIBUTES",)", "", "`mode` is missing"},
           {R"("filter":"NONE")", R"("filter":"OCTAHEDRAL")",
            "byteStride 12 is impossible with filter OCTAHEDRAL"},
           {R"("filter":"NONE")", R"("filter":"QUATERNION")",
            "byteStride 12 is impossible with filter QUATERNION"},
           {R"("byteStride":12)", R"("byteStride":260)", "byteStride"},
           {R"("byteStride":12)", R"("byteStride":6)", "byteStride 6 is impossible in mode ATTRIBUTES"},
           {R"("count":441)", R"("count":440)", "440 elements of 12 bytes do not fill"},
           {R"("count":441)", R"("count":2147483647)", "do not fill"},
           {R"("count":441)", R"("count":-1)", "count"},
           {R"("buffer":0)", R"("buffer":1)", "no data of its own"},
           {R"("buffer":0)", R"("buffer":7)", "index 7"},
           {R"("byteOffset":0)", R"("byteOffset":2000000000)", "of buffers[0]"},
           {R"("byteLength":)", R"("byteLength":9)", "of buffers[0]"},
       })
    EXPECT_THAT(errorOfText(changed(good, mark, c.from, c.to)),
                AllOf(HasSubstr("model.gltf:1:"), HasSubstr("bufferViews[0]"), HasSubstr(c.message)))
        << c.from << " -> " << c.to;
  // The triangles are the fourth view.
  EXPECT_THAT(errorOfText(changed(good, "TRIANGLES", R"("filter":"NONE")", R"("filter":"EXPONENTIAL")")),
              AllOf(HasSubstr("bufferViews[3]"), HasSubstr("is for mode ATTRIBUTES")));
  EXPECT_THAT(errorOfText(changed(good, "bufferViews", R"("extensions":{"EXT_meshopt)",
                                  R"("extensions":{"EXT_other)")),
              AllOf(HasSubstr("bufferViews[0]"), HasSubstr("only compressed buffer views")));
  EXPECT_THAT(errorOfText(changed(good, "fallback", R"(true)", R"(1)")), HasSubstr("fallback"));
  TriangleDocument image = compressedDocument(WavyGrid(4));
  image.extra += R"(,"images":[{"bufferView":0,"mimeType":"image/png"}])";
  EXPECT_THAT(warningsOfText(image.json()), AllOf(HasSubstr("images[0]"), HasSubstr("compressed")));
}

TEST(GltfMeshopt, AFewBytesCannotClaimMuchMemory) {
  CompressedBuilder bomb;
  bomb.accessor(bomb.compressed(Bytes(64), 100000000, 16, "ATTRIBUTES"), 5126, 100000000, "VEC4");
  EXPECT_THAT(errorOfText(bomb.compressedDocument(R"({"attributes":{"POSITION":0}})").json()),
              AllOf(HasSubstr("bufferViews[0]"), HasSubstr("64 bytes cannot hold 100000000 elements")));
  // The same data again and again.
  TriangleDocument d = compressedDocument(WavyGrid(20));
  const std::string first = d.views.substr(1, d.views.find("}}}") + 2);
  for (int i = 0; i < 1000; ++i) d.views.insert(1, first + ",");
  EXPECT_THAT(errorOfText(d.json()), HasSubstr("overlap"));
}

TEST(GltfMeshopt, StreamsThatAreCutShort) {
  const std::string good = compressedDocument(WavyGrid(20)).json();
  const auto lengthOf = [&](size_t extension) {
    return std::stoul(good.substr(good.find("byteLength", extension) + 12));
  };
  int refused = 0;
  for (size_t at = good.find("_compression\":{\"buffer"); at != std::string::npos;
       at = good.find("_compression\":{\"buffer", at + 1)) {
    const size_t length = lengthOf(at);
    for (const size_t cut : {size_t(1), size_t(2), length / 10, length / 2, length - 1}) {
      std::string bad = good;
      const std::string text = "\"byteLength\":" + std::to_string(length);
      bad.replace(bad.find(text, at), text.size(), "\"byteLength\":" + std::to_string(length - cut));
      EXPECT_THAT(errorOfText(bad), AllOf(HasSubstr("model.gltf:1:"), HasSubstr("cut short"))) << cut;
      ++refused;
    }
  }
  EXPECT_EQ(refused, 20);
}

TEST(GltfMeshopt, EveryByteChanged) {
  const std::string good = compressedDocument(WavyGrid(5)).glb();
  TemporaryFolder folder;
  int loaded = 0, refused = 0;
  for (size_t i = 0; i < good.size(); ++i)
    for (const int change : {0x01, 0x80, 0xff})
      (loadsChanged(folder, good, i, change) ? loaded : refused) += 1;
  EXPECT_GT(refused, 1000);
  EXPECT_GT(loaded, 100);
}

}  // namespace
}  // namespace fovea::scene
