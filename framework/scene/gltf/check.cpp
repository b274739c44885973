// Checks everything about a glTF document that can be checked in its JSON: types, indices, sizes and the node graph.
// Runs before tinygltf sees the file, and reports each mistake with its line.
#include "framework/scene/gltf/check.h"

#include <algorithm>

namespace fovea::scene::gltf {
const std::vector<std::string>& supportedExtensions() {
  static const std::vector<std::string> list = {
    "EXT_meshopt_compression",
#if FOVEA_DRACO
    "KHR_draco_mesh_compression",
#endif
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform"
  };
  return list;
}

const json::Value* memberOf(const json::Value* object, std::string_view key) {
  return object ? object->find(key) : nullptr;
}

const json::Value* extensionOf(const json::Value* object, std::string_view name) {
  return memberOf(memberOf(object, "extensions"), name);
}

double numberOr(const json::Value* object, std::string_view key, double fallback) {
  const json::Value* v = memberOf(object, key);
  return v && v->isNumber() ? v->real : fallback;
}

std::string textOr(const json::Value* object, std::string_view key, std::string fallback) {
  const json::Value* v = memberOf(object, key);
  if (v && v->isString()) return v->string;
  return fallback;
}

std::array<double, 3> threeOr(const json::Value* object, std::string_view key, double fallback) {
  std::array<double, 3> out{fallback, fallback, fallback};
  const json::Value* v = memberOf(object, key);
  for (size_t i = 0; v && i < std::min<size_t>(3, v->items.size()); ++i) out[i] = v->items[i].real;
  return out;
}

int indexIn(const json::Value* object, std::string_view key) {
  const json::Value* v = memberOf(object, key);
  return v && v->isInt() ? int(v->integer) : -1;
}

const std::vector<json::Value>& itemsOf(const json::Value* object, std::string_view key) {
  static const std::vector<json::Value> kNone;
  const json::Value* v = memberOf(object, key);
  return v ? v->items : kNone;
}

bool isPlaceholder(const json::Value& buffer) {
  const json::Value* fallback = memberOf(extensionOf(&buffer, kMeshopt), "fallback");
  return fallback && fallback->boolean;
}

bool isSupported(std::string_view extension) {
  const auto& list = supportedExtensions();
  return std::find(list.begin(), list.end(), extension) != list.end();
}

namespace {

class VersionChecker : DocumentReader {
 public:
  using DocumentReader::DocumentReader;
  bool run() {
    if (!root_.isObject()) {
      error(root_, "", "a glTF document is an object, this is " + root_.describe());
      return false;
    }
    return checkAsset() && checkExtensions();
  }

 private:
  bool checkAsset() {
    const Value* asset = root_.find("asset");
    const Value* version = asset && asset->isObject() ? asset->find("version") : nullptr;
    if (!version || !version->isString()) {
      // glTF 1.0 drafts had no asset.version, but their lists were objects.
      const Value* meshes = root_.find("meshes");
      error(asset ? *asset : root_, "asset.version",
            meshes && meshes->isObject()
                ? "no glTF version; the layout looks like glTF 1.0, which is not supported"
                : "the glTF version is missing",
            "only glTF 2.0 can be read");
      return false;
    }
    nameOfObject(*asset, "asset");
    const std::string& v = version->string;
    if (v.substr(0, 2) != "2." || v.size() < 3) {
      error(*version, "asset.version", "glTF version \"" + v.substr(0, 32) + "\" is not supported",
            "convert the model to glTF 2.0");
      return false;
    }
    if (const Value* min = asset->find("minVersion"); min && min->isString() && min->string != "2.0") {
      error(*min, "asset.minVersion",
            "needs glTF version \"" + min->string.substr(0, 32) + "\"; 2.0 is supported");
      return false;
    }
    return true;
  }

  std::vector<const Value*> stringsOf(std::string_view key) {
    std::vector<const Value*> list;
    const Value* v = root_.find(key);
    if (!v) return list;
    if (!v->isArray()) {
      error(*v, std::string(key), "expected an array, found " + v->describe());
      return list;
    }
    for (size_t i = 0; i < v->items.size(); ++i) {
      if (v->items[i].isString())
        list.push_back(&v->items[i]);
      else
        error(v->items[i], at(key, i), "expected a text, found " + v->items[i].describe());
    }
    return list;
  }

  bool checkExtensions() {
    bool fine = true;
    for (const Value* v : stringsOf("extensionsRequired")) {
      if (isSupported(v->string)) continue;
      fine = false;
      error(*v, "extensionsRequired",
            "the model requires the extension `" + v->string + "`, which is not supported",
            "export it without " + v->string + "; supported are " + join(supportedExtensions()));
    }
    return fine;
  }

  static std::string join(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& s : list) text += (text.empty() ? "" : ", ") + s;
    return text;
  }
};

}  // namespace

bool checkVersion(const json::Value& root, const Source& source, Findings& found) {
  return VersionChecker(root, source, found).run();
}

void Findings::apply(json::Value& value) const {
  const auto gone = removed.find(&value);
  for (json::Value& item : value.items) apply(item);
  for (json::Member& m : value.members) apply(m.value);
  if (gone != removed.end())
    std::erase_if(value.members, [&](const json::Member& m) { return gone->second.contains(m.key); });
}

void checkDocument(json::Value& root, const Source& source, Diagnostics& warnings) {
  Findings found;
  if (checkVersion(root, source, found)) {
    checkData(root, source, found);
    checkContent(root, source, found);
    checkUnread(root, source, found);
  }
  found.errors.throwIfErrors();
  for (const Diagnostic& d : found.warnings.list()) warnings.add(d);
  found.apply(root);
}

}  // namespace fovea::scene::gltf
