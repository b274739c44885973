// The parts of the glTF loader. Private to framework/scene.
//
//   file    reads the bytes, checks GLB headers, and finds the JSON text and the binary chunk
//   check   parses the JSON with the project's own parser and applies every rule that keeps tinygltf and the code
//           below inside their buffers
//   parse   calls tinygltf, shut off from the file system, for the lists of accessors, buffer views, meshes and nodes,
//           and reads the buffers
//   decode  puts the content of compressed buffer views and primitives into buffers of their own
//   build   makes materials, meshes, nodes, skins and animations
//
// A mistake without which the rest of the model can be shown costs only its detail: `check` reports it as a warning and
// removes the detail from the document, and `build` reports what it leaves out. Mistakes in the shape of the geometry
// or in the bounds of data are errors.
//
// tinygltf 2.7 was found to leave the following unguarded. It overflows the stack on deep `extras`, reads past the end
// of a GLB whose BIN chunk gives a wrong length, knows no integers with a fraction, truncates large ones, silently
// drops primitives and properties of a wrong type, and never checks accessor bounds, node cycles or extensionsRequired.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"
#include "framework/base/json.h"
#include "framework/scene/scene.h"

// The header of tinygltf is large, so only the .cpp files that need it include it.
namespace tinygltf {
class Model;
}

namespace fovea::scene::gltf {

// Limits on sums over one model, because a few bytes of JSON can claim more memory than any machine has.
inline constexpr uint64_t kMaxFileBytes = (uint64_t(1) << 31) - 1;  // tinygltf counts bytes in int
inline constexpr uint64_t kMaxBufferBytes = uint64_t(1) << 32;
inline constexpr uint64_t kMaxVertices = uint64_t(1) << 26;
inline constexpr uint64_t kMaxZeroElements = uint64_t(1) << 22;  // in accessors without data of their own
inline constexpr uint32_t kMaxTextureSize = 16384;

// What loadGltf() does with the bytes of a file; `file` says where it lies, for messages and for files that it names.
Scene parseGltf(std::vector<uint8_t> bytes, const std::filesystem::path& file, Diagnostics& warnings,
                bool fullMaterials = false);

// ---- file ----

struct Source {
  std::filesystem::path file;
  std::filesystem::path folder;  // absolute; nothing outside it and the real folder of `file` is read
  std::string name;              // as given by the user, for messages
  std::vector<uint8_t> bytes;
  bool binary = false;             // GLB
  std::string_view json;           // inside bytes
  std::span<const uint8_t> chunk;  // the BIN chunk of a GLB, inside bytes
};

// Of the bytes of a file. Throws Error(BadInput) for a damaged container.
Source sourceOf(std::vector<uint8_t> bytes, const std::filesystem::path& file);

// Reads a whole regular file of at most kMaxFileBytes. Throws Error(BadInput) naming it.
std::vector<uint8_t> readFile(const std::filesystem::path& file);

bool isDataUri(std::string_view uri);
// The base64 text of a data URI, whatever media type it names; nothing if it has none.
std::optional<std::string_view> dataOf(std::string_view uri);
struct DataUri {
  std::vector<uint8_t> bytes;
  std::string problem;  // empty if there is none
};
DataUri decodeDataUri(std::string_view uri);
// The file in the folder of the model that a relative URI names, or the problem with it. Percent-encoding is decoded.
struct ResolvedUri {
  std::filesystem::path file;
  std::string decoded;
  std::string problem, remedy;  // empty if there is none
};
ResolvedUri resolveUri(const Source& source, std::string_view uri);
// "the file a.png is missing", and the same of the target of a link.
std::string whyMissing(const std::filesystem::path& file);

// ---- check ----

// Throws Error(BadInput) with every mistake that spoils the model, and its place. Other mistakes are warnings, and what
// they concern is removed from the document.
void checkDocument(json::Value& root, const Source& source, Diagnostics& warnings);

// The extensions that are read: models that need others are refused.
const std::vector<std::string>& supportedExtensions();
bool isSupported(std::string_view extension);

inline constexpr std::string_view kMeshopt = "EXT_meshopt_compression";
inline constexpr std::string_view kDraco = "KHR_draco_mesh_compression";

// What checkDocument has found valid; null if it is absent.
const json::Value* memberOf(const json::Value* object, std::string_view key);
const json::Value* extensionOf(const json::Value* object, std::string_view name);
double numberOr(const json::Value* object, std::string_view key, double fallback);
std::string textOr(const json::Value* object, std::string_view key, std::string fallback);
std::array<double, 3> threeOr(const json::Value* object, std::string_view key, double fallback);
// -1 if there is none.
int indexIn(const json::Value* object, std::string_view key);
// No items if there is no such list.
const std::vector<json::Value>& itemsOf(const json::Value* object, std::string_view key);

// Whether a filter of a sampler shows the nearest texel.
bool isNearest(int filter);

// Whether a buffer merely reserves the places of compressed buffer views, so that nothing of it is read.
bool isPlaceholder(const json::Value& buffer);

// ---- parse ----

// The model has accessors, buffer views, buffers, meshes, nodes and scenes; the rest is read from the document.
void parseModel(const Source& source, const json::Value& root, tinygltf::Model& model);

// ---- decode ----

// Both throw Error(BadInput) with the place of what cannot be decoded.
void decodeBufferViews(const Source& source, const json::Value& root, tinygltf::Model& model);
void decodePrimitives(const Source& source, const json::Value& root, tinygltf::Model& model);

// The bytes of a buffer view, or of a part of a buffer. Throws Error(Internal) past the end of the buffer.
std::span<const uint8_t> bytesOf(const tinygltf::Model& model, int bufferView);
std::span<const uint8_t> bytesOf(const tinygltf::Model& model, size_t buffer, size_t offset, size_t length);
// Adds a buffer and returns its number.
int addBuffer(tinygltf::Model& model, std::vector<unsigned char> bytes);

// ---- build ----

struct Context {
  const Source& source;
  const json::Value& root;
  const tinygltf::Model& model;
  Scene& scene;
  Diagnostics& warnings;
  // For each glTF material, the TEXCOORD sets that its textures read as Primitive::uvs and secondUvs; -1 for none.
  std::vector<std::array<int, 2>> texCoordsOfMaterial{};
  uint32_t defaultMaterial = kNoIndex;  // made on demand for primitives without one
  std::vector<uint32_t> sceneNode{};    // node in the scene for each glTF node; kNoIndex if it is not shown
  std::vector<glm::dmat4> local{};      // transforms of the nodes in the scene, as the file gives them
  uint64_t vertices = 0;
  uint64_t degenerateTriangles = 0, badNormals = 0;

  void warn(std::string path, std::string message, std::string remedy = {}) const;
  // Of what only diffuse materials lack.
  void warnIfDiffuse(std::string path, std::string message, std::string remedy = {}) const;
  [[noreturn]] void fail(std::string path, std::string message, std::string remedy = {}) const;
  // Does something without which the rest of the model can be shown. An error of the model in it becomes a warning that
  // ends with `consequence`, and the result is false.
  bool attempt(const std::function<void()>& part, const std::string& consequence) const;
};

// Reads `components` floats per element, with normalised integers converted and sparse values applied. The caller
// checks whether they are finite.
std::vector<float> readFloats(const Context& c, int accessor, int components, const std::string& path);
std::vector<uint32_t> readIndices(const Context& c, int accessor, const std::string& path);

void buildMaterials(Context& c);
void buildMeshes(Context& c);
void buildNodes(Context& c);  // nodes, lights, cameras

// All cameras of the file, at the origin; for orthographic ones only the name.
std::vector<Camera> readCameras(const Context& c);
bool isOrthographic(const json::Value& camera);
void warnOfOrthographic(const Context& c);  // once the nodes are built
void buildSkins(Context& c);
void buildAnimations(Context& c);  // the first animation that moves anything plays

// Whether a mesh's primitives have `extras.fovea_subdivision` (gltf/cage.cpp).
bool hasCage(const json::Value& primitives);
// Turns the mesh's primitives into its cage. Throws Error(BadInput) with the place of the problem.
void buildCage(const json::Value& primitives, const std::string& place, Mesh& mesh);
void refineCages(Context& c);

// Name for messages, such as "meshes[3] `floor`".
std::string nameOf(std::string_view array, size_t index, const std::string& name);

}  // namespace fovea::scene::gltf
