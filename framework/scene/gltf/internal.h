// The parts of the glTF loader; private to framework/scene.
//
//   file      bytes -> JSON text and binary chunk, GLB headers checked
//   check     the project's own JSON parser and every rule that keeps tinygltf and the code below inside
//   their buffers parse     tinygltf, shut off from the file system except for the buffers that `check`
//   allowed build     materials, meshes, nodes
//
// What tinygltf 2.7 does unguarded, measured: it overflows the stack on deep `extras`, throws on image uri
// ".", opens absolute and ../ paths and files of the working folder, reads past a buffer for an image's
// bufferView and past the end of a GLB whose BIN chunk lies about its length, truncates large integers, drops
// primitives and properties of a wrong type silently, and never looks at accessor bounds, node cycles or
// extensionsRequired.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"
#include "framework/base/json.h"
#include "framework/scene/scene.h"

// tinygltf's header is large: only the .cpp files that need it include it.
namespace tinygltf {
class Model;
}

namespace fovea::scene::gltf {

// Sums over one model; a few bytes of JSON can claim more than any machine holds.
inline constexpr uint64_t kMaxFileBytes = (uint64_t(1) << 31) - 1;  // tinygltf counts in int
inline constexpr uint64_t kMaxBufferBytes = uint64_t(1) << 32;
inline constexpr uint64_t kMaxVertices = uint64_t(1) << 26;
inline constexpr uint64_t kMaxZeroElements = uint64_t(1) << 22;  // of an accessor without data of its own
inline constexpr uint32_t kMaxTextureSize = 16384;

// ---- file ----

struct Source {
  std::filesystem::path file;
  std::filesystem::path folder;  // absolute; nothing outside it is read
  std::string name;              // as the user gave it, for messages
  std::vector<uint8_t> bytes;
  bool binary = false;      // GLB
  std::string_view json;    // inside bytes
  uint64_t binarySize = 0;  // of the BIN chunk
};

Source readSource(const std::filesystem::path& file);

// Whole regular file of at most kMaxFileBytes. Throws Error(BadInput) naming it.
std::vector<uint8_t> readFile(const std::filesystem::path& file);

bool isDataUri(std::string_view uri);
// The file a relative URI names, below `folder`; or what is wrong with it. Percent-encoding is decoded.
struct ResolvedUri {
  std::filesystem::path file;
  std::string decoded;
  std::string problem;  // empty: fine
};
ResolvedUri resolveUri(const std::filesystem::path& folder, std::string_view uri);

// ---- check ----

// Throws Error(BadInput) with every mistake and its place.
void checkDocument(const json::Value& root, const Source& source, Diagnostics& warnings);

// ---- parse ----

// Images come back as their encoded bytes (Image::image, as_is), external ones only as their uri.
void parseModel(const Source& source, const json::Value& root, tinygltf::Model& model);

// ---- build ----

struct Context {
  const Source& source;
  const json::Value& root;
  const tinygltf::Model& model;
  Scene& scene;
  Diagnostics& warnings;
  // Per glTF material: which TEXCOORD set its textures read.
  std::vector<int> texCoordOfMaterial{};
  uint32_t defaultMaterial = kNoIndex;  // made on demand for primitives without one
  std::vector<uint32_t> sceneNode{};    // of each glTF node; kNoIndex when the scene does not show it
  uint64_t vertices = 0;
  uint64_t degenerateTriangles = 0, badNormals = 0;

  void warn(std::string path, std::string message, std::string remedy = {}) const;
  [[noreturn]] void fail(std::string path, std::string message, std::string remedy = {}) const;
};

// `components` floats an element, normalised integers converted, sparse values applied. Finite or not: the
// caller looks.
std::vector<float> readFloats(const Context& c, int accessor, int components, const std::string& path);
std::vector<uint32_t> readIndices(const Context& c, int accessor, const std::string& path);

void buildMaterials(Context& c);
void buildMeshes(Context& c);
void buildNodes(Context& c);  // nodes, lights, cameras
void buildSkins(Context& c);
void buildAnimations(Context& c);  // the first one plays

// `extras.fovea_subdivision` of a mesh's primitives (gltf_cage.cpp).
bool hasCage(const json::Value& primitives);
// The mesh's primitives become its cage. Throws Error(BadInput) with the place of what is wrong.
void buildCage(const json::Value& primitives, const std::string& place, Mesh& mesh);
void refineCages(Context& c);

// "meshes[3] `floor`"
std::string nameOf(std::string_view array, size_t index, const std::string& name);

}  // namespace fovea::scene::gltf
