// The only file that calls tinygltf, with callbacks that can read nothing but the buffers that
// `checkDocument` has seen.
#include <tiny_gltf.h>

#include <algorithm>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

// What the callbacks may read: the path that tinygltf will request -> the size that it must have.
struct Allowed {
  std::map<std::string, uint64_t> files;
};

bool fileExists(const std::string& name, void* user) {
  return static_cast<Allowed*>(user)->files.count(name) > 0;
}

std::string expandPath(const std::string& name, void*) { return name; }  // no ~, no variables, no wordexp

bool readWholeFile(std::vector<unsigned char>* out, std::string* err, const std::string& name, void* user) {
  const auto& files = static_cast<Allowed*>(user)->files;
  const auto found = files.find(name);
  if (found == files.end()) {
    if (err) *err = "refused";
    return false;
  }
  try {
    *out = readFile(name);
  } catch (const Error& e) {
    if (err) *err = e.what();
    return false;
  }
  if (out->size() < found->second) {
    if (err)
      *err = "the file has " + std::to_string(out->size()) + " bytes, the buffer needs " +
             std::to_string(found->second);
    return false;
  }
  out->resize(found->second);  // a longer file is legal, but tinygltf requires equality
  return true;
}

bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

// Keeps the encoded bytes; buildMaterials decodes the images that are used.
bool keepEncoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  image->image.assign(bytes, bytes + size);
  return true;
}

Allowed allowedFiles(const Source& source, const json::Value& root) {
  Allowed allowed;
  const json::Value* buffers = root.find("buffers");
  if (!buffers) return allowed;
  for (const json::Value& b : buffers->items) {
    const json::Value* uri = b.find("uri");
    if (!uri || isDataUri(uri->string) || isPlaceholder(b)) continue;
    // Two buffers may use different lengths of one file. As tinygltf requires exact sizes, this is refused.
    const std::string name = source.folder.string() + "/" + resolveUri(source, uri->string).decoded;
    const uint64_t size = uint64_t(b.find("byteLength")->integer);
    const auto [at, added] = allowed.files.emplace(name, size);
    if (!added && at->second != size)
      throw Error(ExitCode::BadInput,
                  source.name + ": two buffers name the file " + name + " with different lengths",
                  "give them the same byteLength");
  }
  return allowed;
}

// Shortens messages, because tinygltf repeats whole data URIs in them.
std::string shorten(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  constexpr size_t kLimit = 400;
  if (text.size() > kLimit) text = text.substr(0, kLimit) + "...";
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text.empty() ? "the file cannot be read as glTF" : text;
}

bool isPrimitiveToDecode(const json::Value& primitive) {
  return isSupported(kDraco) && extensionOf(&primitive, kDraco);
}

void leaveOutIndices(json::Value& primitive) {
  if (isPrimitiveToDecode(primitive))
    std::erase_if(primitive.members, [](const json::Member& m) { return m.key == "indices"; });
}

// The cameras are read without tinygltf, which refuses a file in which one of them lacks a number.
bool isComplete(const json::Value& camera) {
  const json::Value* type = camera.find("type");
  if (!type) return false;
  const json::Value* lens = camera.find(type->string);
  const auto has = [&](const char* key) { return lens && lens->find(key); };
  return isOrthographic(camera) ? has("xmag") && has("ymag") && has("zfar") && has("znear")
                                : has("yfov") && has("znear");
}

bool needsChange(const json::Value& root) {
  bool found = false;
  if (const json::Value* cameras = root.find("cameras"))
    found = !std::all_of(cameras->items.begin(), cameras->items.end(), isComplete);
  if (const json::Value* buffers = root.find("buffers"))
    for (const json::Value& b : buffers->items) found = found || isPlaceholder(b);
  if (const json::Value* meshes = root.find("meshes"))
    for (const json::Value& mesh : meshes->items)
      for (const json::Value& p : mesh.find("primitives")->items) found = found || isPrimitiveToDecode(p);
  return found;
}

// The document without cameras and without what is still to be decoded, because tinygltf insists on the data of buffers
// and indices: each placeholder has one byte, and primitives have no indices.
std::string changed(json::Value root) {
  static const json::Value kOneByte =
      json::parse(R"({"byteLength":1,"uri":"data:application/octet-stream;base64,AA=="})", "placeholder");
  std::erase_if(root.members, [](const json::Member& m) { return m.key == "cameras"; });
  for (json::Member& list : root.members) {
    if (list.key == "buffers")
      std::replace_if(list.value.items.begin(), list.value.items.end(), isPlaceholder, kOneByte);
    if (list.key != "meshes") continue;
    for (json::Value& mesh : list.value.items)
      for (json::Member& part : mesh.members)
        if (part.key == "primitives")
          std::for_each(part.value.items.begin(), part.value.items.end(), leaveOutIndices);
  }
  return json::print(root);
}

void append(std::vector<uint8_t>& to, uint32_t value) {
  for (int i = 0; i < 4; ++i) to.push_back(uint8_t(value >> 8 * i));
}

// Appends a chunk of a GLB file (glTF 2.0, 4.4.3).
void append(std::vector<uint8_t>& to, std::string_view type, std::span<const uint8_t> content,
            uint8_t padding) {
  const size_t size = (content.size() + 3) / 4 * 4;
  append(to, uint32_t(size));
  to.insert(to.end(), type.begin(), type.end());
  to.insert(to.end(), content.begin(), content.end());
  to.insert(to.end(), size - content.size(), padding);
}

// A GLB file made of a document and the binary chunk of a source.
std::vector<uint8_t> glbOf(const std::string& document, const Source& source) {
  std::vector<uint8_t> glb = {'g', 'l', 'T', 'F', 2, 0, 0, 0, 0, 0, 0, 0};
  append(glb, "JSON", {reinterpret_cast<const uint8_t*>(document.data()), document.size()}, ' ');
  if (!source.chunk.empty()) append(glb, std::string_view("BIN\0", 4), source.chunk, 0);
  std::vector<uint8_t> size;
  append(size, uint32_t(glb.size()));
  std::copy(size.begin(), size.end(), glb.begin() + 8);
  return glb;
}

bool load(const Source& source, const json::Value& root, tinygltf::TinyGLTF& loader, tinygltf::Model& model,
          std::string& error) {
  std::string warning;
  const std::string folder = source.folder.string();
  std::string document;
  std::vector<uint8_t> glb;
  std::span<const uint8_t> file = source.bytes;
  std::string_view text = source.json;
  if (needsChange(root)) {
    text = document = changed(root);
    if (source.binary) file = glb = glbOf(document, source);
  }
  if (source.binary)
    return loader.LoadBinaryFromMemory(&model, &error, &warning, file.data(), unsigned(file.size()), folder);
  return loader.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), folder);
}

}  // namespace

void parseModel(const Source& source, const json::Value& root, tinygltf::Model& model) {
  Allowed allowed = allowedFiles(source, root);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({&fileExists, &expandPath, &readWholeFile, &writeNothing, &allowed});
  loader.SetImageLoader(&keepEncoded, nullptr);
  std::string error;
  bool ok = false;
  try {
    ok = load(source, root, loader, model, error);
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::OutOfMemory, source.name + ": not enough memory for the model's buffers");
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!ok) throw Error(ExitCode::BadInput, source.name + ": " + shorten(error));
  // The lists must have the lengths that `checkDocument` checked every index against.
  const auto same = [&](const char* key, size_t size) {
    const json::Value* list = root.find(key);
    if ((list ? list->items.size() : 0) != size)
      throw Error(ExitCode::BadInput,
                  source.name + ": `" + key + "` was only partly understood: " + shorten(error));
  };
  same("accessors", model.accessors.size());
  same("bufferViews", model.bufferViews.size());
  same("buffers", model.buffers.size());
  same("images", model.images.size());
  same("samplers", model.samplers.size());
  same("textures", model.textures.size());
  same("materials", model.materials.size());
  same("meshes", model.meshes.size());
  same("nodes", model.nodes.size());
  same("scenes", model.scenes.size());
  same("skins", model.skins.size());
}

}  // namespace fovea::scene::gltf
