// The only file that calls tinygltf, with callbacks that can read nothing but the buffers that
// `checkDocument` has seen.
#include <tiny_gltf.h>

#include <set>

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
    if (!uri || isDataUri(uri->string)) continue;
    // Two buffers may use different lengths of one file. As tinygltf requires exact sizes, this is refused.
    const std::string name = source.folder.string() + "/" + resolveUri(source.folder, uri->string).decoded;
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

}  // namespace

void parseModel(const Source& source, const json::Value& root, tinygltf::Model& model) {
  Allowed allowed = allowedFiles(source, root);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({&fileExists, &expandPath, &readWholeFile, &writeNothing, &allowed});
  loader.SetImageLoader(&keepEncoded, nullptr);
  std::string error, warning;
  bool ok = false;
  try {
    if (source.binary)
      ok = loader.LoadBinaryFromMemory(&model, &error, &warning, source.bytes.data(),
                                       unsigned(source.bytes.size()), source.folder.string());
    else
      ok = loader.LoadASCIIFromString(&model, &error, &warning, source.json.data(),
                                      unsigned(source.json.size()), source.folder.string());
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
  same("cameras", model.cameras.size());
  same("skins", model.skins.size());
}

}  // namespace fovea::scene::gltf
