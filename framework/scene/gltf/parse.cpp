// The only file that calls tinygltf, which reads the lists of accessors, buffer views, meshes, nodes and scenes from a
// document that is written for it, and can open no file. Buffers are read here.
#include <tiny_gltf.h>

#include <algorithm>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

using json::Value;

bool fileExists(const std::string&, void*) { return false; }

std::string expandPath(const std::string& name, void*) { return name; }

bool readNothing(std::vector<unsigned char>*, std::string* err, const std::string&, void*) {
  if (err) *err = "refused";
  return false;
}

bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

// Shortens messages, because tinygltf repeats whole objects in them.
std::string shorten(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  constexpr size_t kLimit = 400;
  if (text.size() > kLimit) text = text.substr(0, kLimit) + "...";
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text.empty() ? "the file cannot be read as glTF" : text;
}

// A copy without extensions and extras, which are read from the document itself, in which whole numbers are written
// without a fraction and without an exponent, because tinygltf knows no others.
Value plain(const Value& from) {
  Value to;
  to.type = from.type == Value::Type::Real && from.isInt() ? Value::Type::Int : from.type;
  to.boolean = from.boolean;
  to.string = from.string;
  to.integer = from.integer;
  to.real = from.real;
  for (const Value& item : from.items) to.items.push_back(plain(item));
  for (const json::Member& m : from.members)
    if (m.key != "extensions" && m.key != "extras") to.members.push_back({m.key, plain(m.value), {}});
  return to;
}

// tinygltf insists on the data of indices, which compressed primitives do not have yet.
void leaveOutCompressedIndices(const Value& written, Value& meshes) {
  for (size_t m = 0; isSupported(kDraco) && m < meshes.items.size(); ++m)
    for (json::Member& list : meshes.items[m].members)
      for (size_t i = 0; list.key == "primitives" && i < list.value.items.size(); ++i)
        if (extensionOf(&written.items[m].find("primitives")->items[i], kDraco))
          std::erase_if(list.value.items[i].members,
                        [](const json::Member& p) { return p.key == "indices"; });
}

// What tinygltf is to read of a document. It insists on the data of buffers, too: each has one byte.
std::string documentOf(const Value& root) {
  Value document = json::parse(R"({"asset":{"version":"2.0"}})", "glTF");
  const Value buffer =
      json::parse(R"({"byteLength":1,"uri":"data:application/octet-stream;base64,AA=="})", "glTF");
  const Value nothing = json::parse(R"({"componentType":5126,"count":0,"type":"SCALAR"})", "glTF");
  for (const json::Member& m : root.members) {
    if (m.key == "buffers") {
      Value buffers;
      buffers.type = Value::Type::Array;
      buffers.items.assign(m.value.items.size(), buffer);
      document.members.push_back({m.key, std::move(buffers), {}});
    }
    for (const char* key : {"accessors", "bufferViews", "meshes", "nodes", "scenes", "scene"})
      if (m.key == key) document.members.push_back({m.key, plain(m.value), {}});
    if (m.key == "accessors")  // without a count, it is left out
      for (size_t i = 0; i < m.value.items.size(); ++i)
        if (!m.value.items[i].find("count")) document.members.back().value.items[i] = nothing;
    if (m.key == "meshes") leaveOutCompressedIndices(m.value, document.members.back().value);
  }
  return json::print(document);
}

// The content of a buffer; files and data uris may be longer than it.
std::vector<uint8_t> bytesOfBuffer(const Source& source, const Value& buffer, const std::string& place) {
  if (isPlaceholder(buffer)) return {0};
  const size_t size = size_t(buffer.find("byteLength")->integer);
  const Value* uri = buffer.find("uri");
  if (!uri) return {source.chunk.begin(), source.chunk.begin() + std::ptrdiff_t(size)};
  const auto fail = [&](const std::string& message, const char* remedy) {
    throw Error(ExitCode::BadInput,
                {{Severity::Error, uri->where.location(), place + ".uri", message, remedy}});
  };
  std::vector<uint8_t> bytes;
  std::string name = "the data uri";
  if (isDataUri(uri->string)) {
    DataUri data = decodeDataUri(uri->string);
    if (!data.problem.empty()) fail(data.problem, "export the model again");
    bytes = std::move(data.bytes);
  } else {
    const std::filesystem::path file = resolveUri(source, uri->string).file;
    name = "the file " + file.string();
    bytes = readFile(file);
  }
  if (bytes.size() < size)
    fail(name + " has " + std::to_string(bytes.size()) + " bytes, the buffer needs " + std::to_string(size),
         "the model is cut short; export or copy it again");
  bytes.resize(size);
  return bytes;
}

}  // namespace

void parseModel(const Source& source, const Value& root, tinygltf::Model& model) {
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({&fileExists, &expandPath, &readNothing, &writeNothing, nullptr});
  std::string error;
  bool ok = false;
  try {
    const std::string document = documentOf(root);
    std::string warning;
    ok = loader.LoadASCIIFromString(&model, &error, &warning, document.data(), unsigned(document.size()), "");
    for (size_t i = 0; ok && i < model.buffers.size(); ++i)
      model.buffers[i].data = bytesOfBuffer(source, root.find("buffers")->items[i], nameOf("buffers", i, ""));
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::OutOfMemory, source.name + ": not enough memory for the model's buffers");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!ok) throw Error(ExitCode::BadInput, source.name + ": " + shorten(error));
  // The lists must have the lengths that `checkDocument` checked every index against.
  const auto same = [&](const char* key, size_t size) {
    const Value* list = root.find(key);
    if ((list ? list->items.size() : 0) != size)
      throw Error(ExitCode::BadInput,
                  source.name + ": `" + key + "` was only partly understood: " + shorten(error));
  };
  same("accessors", model.accessors.size());
  same("bufferViews", model.bufferViews.size());
  same("buffers", model.buffers.size());
  same("meshes", model.meshes.size());
  same("nodes", model.nodes.size());
  same("scenes", model.scenes.size());
}

}  // namespace fovea::scene::gltf
