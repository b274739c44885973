// Everything about a glTF document that can be told from its JSON: types, indices, sizes, the node graph. Runs before
// tinygltf sees the file, and reports each mistake with its line.
#include <algorithm>
#include <array>
#include <functional>

#include "framework/scene/gltf_internal.h"

namespace fovea::scene::gltf {
namespace {

using json::ObjectReader;
using json::Value;

constexpr int64_t kIntMax = 0x7fffffff;

const std::vector<std::string>& supportedExtensions() {
  static const std::vector<std::string> list = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                                "KHR_mesh_quantization", "KHR_texture_transform"};
  return list;
}

int componentBytes(int64_t type) {
  switch (type) {
    case 5120: case 5121: return 1;
    case 5122: case 5123: return 2;
    case 5125: case 5126: return 4;
    default: return 0;
  }
}

int componentCount(const std::string& type) {
  static const std::array<std::pair<const char*, int>, 7> kTypes = {
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
  for (const auto& [name, count] : kTypes)
    if (type == name) return count;
  return 0;
}

// Columns of matrices start at multiples of four bytes (glTF 2.0, 3.6.2.4).
int64_t elementBytes(const std::string& type, int64_t componentType) {
  const int bytes = componentBytes(componentType);
  if (type == "MAT2" && bytes == 1) return 8;
  if (type == "MAT3" && bytes == 1) return 12;
  if (type == "MAT3" && bytes == 2) return 24;
  return int64_t(componentCount(type)) * bytes;
}

std::string at(std::string_view array, size_t i) { return std::string(array) + "[" + std::to_string(i) + "]"; }

class Checker {
 public:
  Checker(const Value& root, const Source& source) : root_(root), source_(source) {}

  Diagnostics run(Diagnostics& warnings) {
    if (!root_.isObject()) {
      error(root_, "", "a glTF document is an object, this is " + root_.describe());
      return std::move(errors_);
    }
    if (!checkAsset()) return std::move(errors_);
    if (!checkExtensions(warnings)) return std::move(errors_);
    checkBuffers();
    checkBufferViews();
    each("accessors", [&](const Value& v, const std::string& path) { checkAccessor(v, path); });
    checkImagesAndTextures();
    each("materials", [&](const Value& v, const std::string& path) { checkMaterial(v, path); });
    each("meshes", [&](const Value& v, const std::string& path) { checkMesh(v, path); });
    checkCamerasAndLights();
    checkNodes();
    checkSkinsAndAnimations();
    return std::move(errors_);
  }

 private:
  void error(const Value& v, std::string path, std::string message, std::string remedy = {}) {
    errors_.error(v.where.location(), std::move(path), std::move(message), std::move(remedy));
  }

  size_t sizeOf(std::string_view array) const {
    const Value* v = root_.find(array);
    return v && v->isArray() ? v->items.size() : 0;
  }

  void each(std::string_view array, const std::function<void(const Value&, const std::string&)>& visit) {
    const Value* v = root_.find(array);
    if (!v) return;
    eachOf(*v, std::string(array), visit);
  }

  // Every item must be an object.
  void eachOf(const Value& v, const std::string& path, const std::function<void(const Value&, const std::string&)>& visit) {
    if (!v.isArray()) return error(v, path, "expected an array, found " + v.describe());
    for (size_t i = 0; i < v.items.size(); ++i) {
      if (!v.items[i].isObject())
        error(v.items[i], at(path, i), "expected an object, found " + v.items[i].describe());
      else
        visit(v.items[i], at(path, i));
    }
  }

  bool indexValue(const Value& v, const std::string& path, std::string_view target) {
    const size_t count = sizeOf(target);
    if (!v.isInt()) {
      error(v, path, "expected an index into `" + std::string(target) + "`, found " + v.describe());
      return false;
    }
    if (v.integer < 0 || uint64_t(v.integer) >= count) {
      error(v, path,
            "index " + std::to_string(v.integer) + " into `" + std::string(target) + "`, which has " +
                std::to_string(count) + " entries");
      return false;
    }
    return true;
  }

  // -1 when absent or wrong.
  int64_t index(const Value& object, const std::string& path, std::string_view key, std::string_view target,
                bool required = false) {
    const Value* v = object.find(key);
    if (!v) {
      if (required) error(object, path, "`" + std::string(key) + "` is missing");
      return -1;
    }
    return indexValue(*v, json::joinPath(path, key), target) ? v->integer : -1;
  }

  void indexArray(const Value& object, const std::string& path, std::string_view key, std::string_view target) {
    const Value* v = object.find(key);
    if (!v) return;
    const std::string place = json::joinPath(path, key);
    if (!v->isArray()) return error(*v, place, "expected an array, found " + v->describe());
    for (size_t i = 0; i < v->items.size(); ++i) indexValue(v->items[i], at(place, i), target);
  }

  void numbersIfPresent(const Value& object, const std::string& path, std::string_view key, size_t count) {
    if (object.find(key)) ObjectReader(object, path, errors_).numbers(key, count);
  }

  void nameOfObject(const Value& object, const std::string& path) { ObjectReader(object, path, errors_).text("name"); }

  // Extensions of any object: an object of objects.
  const Value* extension(const Value& object, const std::string& path, std::string_view name) {
    const Value* all = object.find("extensions");
    if (!all) return nullptr;
    if (!all->isObject()) {
      error(*all, json::joinPath(path, "extensions"), "expected an object, found " + all->describe());
      return nullptr;
    }
    const Value* v = all->find(name);
    if (!v) return nullptr;
    if (!v->isObject()) {
      error(*v, json::joinPath(json::joinPath(path, "extensions"), name), "expected an object, found " + v->describe());
      return nullptr;
    }
    return v;
  }

  bool checkAsset() {
    const Value* asset = root_.find("asset");
    const Value* version = asset && asset->isObject() ? asset->find("version") : nullptr;
    if (!version || !version->isString()) {
      // glTF 1.0 drafts knew no asset.version but kept their lists as objects.
      const Value* meshes = root_.find("meshes");
      error(asset ? *asset : root_, "asset.version",
            meshes && meshes->isObject() ? "no glTF version; the layout looks like glTF 1.0, which is not supported"
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
      error(*min, "asset.minVersion", "needs glTF version \"" + min->string.substr(0, 32) + "\"; 2.0 is supported");
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

  bool checkExtensions(Diagnostics& warnings) {
    const auto supported = [](const std::string& name) {
      const auto& list = supportedExtensions();
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    bool fine = true;
    for (const Value* v : stringsOf("extensionsRequired")) {
      if (supported(v->string)) continue;
      fine = false;
      error(*v, "extensionsRequired", "the model requires the extension `" + v->string + "`, which is not supported",
            "export it without " + v->string + "; supported are " + join(supportedExtensions()));
    }
    if (!fine) return false;
    std::vector<std::string> ignored;
    for (const Value* v : stringsOf("extensionsUsed"))
      if (!supported(v->string)) ignored.push_back(v->string);
    if (!ignored.empty())
      warnings.warning({source_.name, 0, 0}, "extensionsUsed",
                       "ignored: " + join(ignored) + "; the model's fall-back is shown instead");
    return true;
  }

  static std::string join(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& s : list) text += (text.empty() ? "" : ", ") + s;
    return text;
  }

  void checkUri(const Value& object, const std::string& path, bool mustExist) {
    const Value* uri = object.find("uri");
    if (!uri) return;
    const std::string place = path + ".uri";
    if (!uri->isString()) return error(*uri, place, "expected a text, found " + uri->describe());
    if (isDataUri(uri->string)) return;
    const ResolvedUri r = resolveUri(source_.folder, uri->string);
    if (!r.problem.empty())
      return error(*uri, place, "uri \"" + uri->string.substr(0, 200) + "\": " + r.problem,
                   "put the file into the model's folder and name it relative to that");
    std::error_code ec;
    if (mustExist && !std::filesystem::is_regular_file(r.file, ec))
      error(*uri, place, "the file " + r.file.string() + " is missing", "copy it beside the model");
  }

  void checkBuffers() {
    uint64_t total = 0;
    size_t i = 0;
    each("buffers", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      if (!r.require("byteLength")) return;
      const int64_t size = r.integer("byteLength", 0, 1, int64_t(kMaxFileBytes));
      total += uint64_t(std::max<int64_t>(size, 0));
      checkUri(v, path, true);
      if (!v.find("uri")) {
        if (!source_.binary || i > 0)
          error(v, path, "the buffer has no uri", "only the first buffer of a GLB file may live in the file itself");
        else if (uint64_t(size) > source_.binarySize)
          error(v, path, "byteLength " + std::to_string(size) + " exceeds the GLB's BIN chunk of " +
                             std::to_string(source_.binarySize) + " bytes");
      }
      ++i;
    });
    if (total > kMaxBufferBytes)
      error(*root_.find("buffers"), "buffers", "the buffers have " + std::to_string(total) + " bytes in all; at most " +
                                                   std::to_string(kMaxBufferBytes) + " can be read");
  }

  void checkBufferViews() {
    each("bufferViews", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      const int64_t buffer = index(v, path, "buffer", "buffers", true);
      const int64_t offset = r.integer("byteOffset", 0, 0, kIntMax);
      const int64_t length = r.require("byteLength") ? r.integer("byteLength", 0, 1, kIntMax) : 0;
      r.integer("byteStride", 4, 1, 252);
      r.integer("target", 34962, 0, kIntMax);
      if (buffer < 0) return;
      const int64_t size = integerAt("buffers", buffer, "byteLength", 0);
      if (offset + length > size)
        error(v, path, "bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) + " of buffers[" +
                           std::to_string(buffer) + "], which has " + std::to_string(size) + " bytes");
    });
  }

  // A number of another object, whatever its type; that object's own check has reported it if it is wrong.
  int64_t integerAt(std::string_view array, int64_t i, std::string_view key, int64_t fallback) const {
    const Value* v = root_.find(array);
    const Value* member = v->items[size_t(i)].find(key);
    return member && member->isInt() && member->integer >= 0 && member->integer <= kIntMax ? member->integer : fallback;
  }

  void checkSpan(const Value& v, const std::string& path, int64_t view, int64_t offset, int64_t count, int64_t bytes,
                 bool strided) {
    if (view < 0 || count <= 0 || bytes <= 0) return;
    const int64_t stride = strided ? integerAt("bufferViews", view, "byteStride", bytes) : bytes;
    const int64_t length = integerAt("bufferViews", view, "byteLength", 0);
    if (length == 0) return;  // reported with the view
    if (stride < bytes)
      return error(v, path, "elements of " + std::to_string(bytes) + " bytes overlap: bufferViews[" +
                                std::to_string(view) + "].byteStride is " + std::to_string(stride));
    // All factors are below 2^31: no overflow in 64 bits.
    const int64_t end = offset + (count - 1) * stride + bytes;
    if (end > length)
      error(v, path, std::to_string(count) + " elements end at byte " + std::to_string(end) + " of bufferViews[" +
                         std::to_string(view) + "], which has " + std::to_string(length) + " bytes");
  }

  void checkAccessor(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    ObjectReader r(v, path, errors_);
    const int64_t view = index(v, path, "bufferView", "bufferViews");
    const int64_t offset = r.integer("byteOffset", 0, 0, kIntMax);
    const int64_t count = r.require("count") ? r.integer("count", 0, 1, kIntMax) : 0;
    const int64_t component = r.require("componentType") ? r.integer("componentType", 0, 0, kIntMax) : 0;
    const std::string type = r.require("type") ? r.text("type") : "";
    r.boolean("normalized", false);
    if (v.find("componentType") && componentBytes(component) == 0)
      return error(v, path, "componentType " + std::to_string(component) + " is none of 5120, 5121, 5122, 5123, 5125, 5126");
    if (componentCount(type) == 0) {
      if (v.find("type") && v.find("type")->isString())
        error(v, path, "type \"" + type.substr(0, 32) + "\" is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
      return;
    }
    for (const char* key : {"min", "max"}) numbersIfPresent(v, path, key, size_t(componentCount(type)));
    checkSpan(v, path, view, offset, count, elementBytes(type, component), true);
    if (!v.find("bufferView") && uint64_t(count) > kMaxZeroElements)
      error(v, path, "an accessor without a bufferView claims " + std::to_string(count) + " elements; at most " +
                         std::to_string(kMaxZeroElements) + " are accepted");
    if (v.find("sparse")) checkSparse(*v.find("sparse"), path + ".sparse", count, elementBytes(type, component));
  }

  void checkSparse(const Value& v, const std::string& path, int64_t elements, int64_t bytes) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    ObjectReader r(v, path, errors_);
    const int64_t count = r.require("count") ? r.integer("count", 0, 1, std::max<int64_t>(elements, 1)) : 0;
    for (const char* key : {"indices", "values"}) {
      const Value* part = r.require(key) ? r.object(key) : nullptr;
      if (!part) continue;
      const std::string place = json::joinPath(path, key);
      ObjectReader p(*part, place, errors_);
      const int64_t view = index(*part, place, "bufferView", "bufferViews", true);
      const int64_t offset = p.integer("byteOffset", 0, 0, kIntMax);
      int64_t size = bytes;
      if (std::string_view(key) == "indices") {
        const int64_t component = p.require("componentType") ? p.integer("componentType", 0, 0, kIntMax) : 0;
        if (component != 5121 && component != 5123 && component != 5125) {
          error(*part, place, "componentType " + std::to_string(component) + " is none of 5121, 5123, 5125");
          continue;
        }
        size = componentBytes(component);
      }
      checkSpan(*part, place, view, offset, count, size, false);
    }
  }

  void checkImagesAndTextures() {
    each("images", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "bufferView", "bufferViews");
      ObjectReader(v, path, errors_).text("mimeType");
      if (v.find("uri") && v.find("bufferView")) error(v, path, "an image has either a uri or a bufferView, this one both");
      if (!v.find("uri") && !v.find("bufferView")) error(v, path, "the image has neither uri nor bufferView");
      checkUri(v, path, false);
    });
    each("samplers", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      for (const char* key : {"wrapS", "wrapT", "magFilter", "minFilter"}) r.integer(key, 10497, 0, kIntMax);
    });
    each("textures", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "source", "images");
      index(v, path, "sampler", "samplers");
    });
  }

  void checkTextureInfo(const Value& object, const std::string& path, std::string_view key) {
    const Value* v = object.find(key);
    if (!v) return;
    const std::string place = json::joinPath(path, key);
    if (!v->isObject()) return error(*v, place, "expected an object, found " + v->describe());
    index(*v, place, "index", "textures", true);
    ObjectReader r(*v, place, errors_);
    r.integer("texCoord", 0, 0, 255);
    r.number("scale", 1);
    r.number("strength", 1);
    const Value* t = extension(*v, place, "KHR_texture_transform");
    if (!t) return;
    const std::string inside = place + ".extensions.KHR_texture_transform";
    numbersIfPresent(*t, inside, "offset", 2);
    numbersIfPresent(*t, inside, "scale", 2);
    ObjectReader x(*t, inside, errors_);
    x.number("rotation", 0);
    x.integer("texCoord", 0, 0, 255);
  }

  void checkMaterial(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    ObjectReader r(v, path, errors_);
    numbersIfPresent(v, path, "emissiveFactor", 3);
    r.choice("alphaMode", "OPAQUE", {"OPAQUE", "MASK", "BLEND"});
    r.number("alphaCutoff", 0.5);
    r.boolean("doubleSided", false);
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) checkTextureInfo(v, path, key);
    if (const Value* e = extension(v, path, "KHR_materials_emissive_strength"))
      ObjectReader(*e, path + ".extensions.KHR_materials_emissive_strength", errors_).number("emissiveStrength", 1, 0);
    if (const Value* pbr = r.object("pbrMetallicRoughness")) {
      const std::string place = path + ".pbrMetallicRoughness";
      ObjectReader p(*pbr, place, errors_);
      numbersIfPresent(*pbr, place, "baseColorFactor", 4);
      p.number("metallicFactor", 1);
      p.number("roughnessFactor", 1);
      checkTextureInfo(*pbr, place, "baseColorTexture");
      checkTextureInfo(*pbr, place, "metallicRoughnessTexture");
    }
  }

  void checkAttributes(const Value& v, const std::string& path) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    for (const json::Member& m : v.members) indexValue(m.value, json::joinPath(path, m.key), "accessors");
  }

  void checkMesh(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    const Value* primitives = v.find("primitives");
    if (!primitives) return error(v, path, "the mesh has no `primitives`");
    if (primitives->isArray() && primitives->items.empty()) error(*primitives, path + ".primitives", "the list is empty");
    eachOf(*primitives, path + ".primitives", [&](const Value& p, const std::string& place) {
      index(p, place, "indices", "accessors");
      index(p, place, "material", "materials");
      ObjectReader r(p, place, errors_);
      r.integer("mode", 4, 0, 6);
      if (const Value* attributes = r.require("attributes")) checkAttributes(*attributes, place + ".attributes");
      if (const Value* targets = r.array("targets"))
        for (size_t i = 0; i < targets->items.size(); ++i)
          checkAttributes(targets->items[i], at(place + ".targets", i));
    });
    if (const Value* weights = ObjectReader(v, path, errors_).array("weights"))
      numbersIfPresent(v, path, "weights", weights->items.size());
  }

  void checkCamerasAndLights() {
    each("cameras", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      const std::string type = r.choice("type", "perspective", {"perspective", "orthographic"});
      if (const Value* p = r.object("perspective")) {
        ObjectReader q(*p, path + ".perspective", errors_);
        q.number("yfov", 1, 1e-3, 3.14159);
        q.number("znear", 0.1, 1e-6);
        q.number("zfar", 0, 0);
        q.number("aspectRatio", 1, 0);
      } else if (type == "perspective") {
        error(v, path, "a perspective camera needs `perspective`");
      }
    });
    const Value* lights = extension(root_, "", "KHR_lights_punctual");
    if (!lights) return;
    const std::string place = "extensions.KHR_lights_punctual.lights";
    const Value* list = lights->find("lights");
    if (!list) return error(*lights, place, "`lights` is missing");
    if (list->isArray()) lightCount_ = list->items.size();
    eachOf(*list, place, [&](const Value& v, const std::string& path) { checkLight(v, path); });
  }

  void checkLight(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    ObjectReader r(v, path, errors_);
    if (!r.require("type")) return;
    const std::string type = r.choice("type", "point", {"directional", "point", "spot"});
    numbersIfPresent(v, path, "color", 3);
    r.number("intensity", 1, 0);
    r.number("range", 0, 0);
    const Value* spot = r.object("spot");
    if (!spot) {
      if (type == "spot") error(v, path, "a spot light needs `spot`");
      return;
    }
    ObjectReader s(*spot, path + ".spot", errors_);
    constexpr double kRightAngle = 1.5708;
    const double inner = s.number("innerConeAngle", 0, 0, kRightAngle);
    const double outer = s.number("outerConeAngle", 0.7853981633974483, 0, kRightAngle);
    if (inner >= outer)
      error(*spot, path + ".spot", "innerConeAngle " + std::to_string(inner) + " is not below outerConeAngle " +
                                       std::to_string(outer));
  }

  void checkNodes() {
    each("nodes", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "mesh", "meshes");
      index(v, path, "camera", "cameras");
      index(v, path, "skin", "skins");
      indexArray(v, path, "children", "nodes");
      numbersIfPresent(v, path, "matrix", 16);
      numbersIfPresent(v, path, "translation", 3);
      numbersIfPresent(v, path, "rotation", 4);
      numbersIfPresent(v, path, "scale", 3);
      if (const Value* e = extension(v, path, "KHR_lights_punctual")) checkLightOfNode(*e, path);
    });
    each("scenes", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      indexArray(v, path, "nodes", "nodes");
    });
    // A file without scenes may still name scene 0 (and show nothing).
    if (root_.find("scenes") || (root_.find("scene") && !root_.find("scene")->isInt()))
      index(root_, "", "scene", "scenes");
    checkNodeTree();
  }

  void checkLightOfNode(const Value& e, const std::string& path) {
    const std::string place = path + ".extensions.KHR_lights_punctual.light";
    const Value* light = e.find("light");
    if (!light || !light->isInt() || light->integer < 0 || uint64_t(light->integer) >= lightCount_)
      error(light ? *light : e, place, "expected an index into the model's " + std::to_string(lightCount_) + " lights");
  }

  // Strict trees (glTF 2.0, 3.5.1): at most one parent each, no cycles.
  void checkNodeTree() {
    const size_t count = sizeOf("nodes");
    std::vector<int64_t> parent(count, -1);
    const Value* nodes = root_.find("nodes");
    for (size_t i = 0; i < count; ++i) {
      const Value* children = nodes->items[i].find("children");
      if (!children || !children->isArray()) continue;
      for (const Value& child : children->items) {
        if (!child.isInt() || child.integer < 0 || uint64_t(child.integer) >= count) continue;
        int64_t& p = parent[size_t(child.integer)];
        if (p >= 0)
          error(child, at("nodes", i) + ".children",
                "node " + std::to_string(child.integer) + " is a child of node " + std::to_string(p) + " and of node " +
                    std::to_string(i) + "; a node has one parent");
        p = int64_t(i);
      }
    }
    // With one parent each, walking up either ends at a root or runs in a circle.
    std::vector<uint8_t> known(count, 0);  // 1: on the current walk, 2: ends at a root or was reported
    for (size_t i = 0; i < count; ++i) {
      std::vector<size_t> walk;
      int64_t n = int64_t(i);
      while (n >= 0 && known[size_t(n)] == 0) {
        known[size_t(n)] = 1;
        walk.push_back(size_t(n));
        n = parent[size_t(n)];
      }
      if (n >= 0 && known[size_t(n)] == 1)
        error(nodes->items[size_t(n)], at("nodes", size_t(n)), "node " + std::to_string(n) + " is its own ancestor");
      for (size_t w : walk) known[w] = 2;
    }
  }

  void checkSkinsAndAnimations() {
    each("skins", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "inverseBindMatrices", "accessors");
      index(v, path, "skeleton", "nodes");
      indexArray(v, path, "joints", "nodes");
    });
    each("animations", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      const Value* samplers = v.find("samplers");
      const Value* channels = v.find("channels");
      if (samplers)
        eachOf(*samplers, path + ".samplers", [&](const Value& s, const std::string& place) {
          index(s, place, "input", "accessors", true);
          index(s, place, "output", "accessors", true);
          ObjectReader(s, place, errors_).text("interpolation");
        });
      if (!channels) return;
      const size_t count = samplers && samplers->isArray() ? samplers->items.size() : 0;
      eachOf(*channels, path + ".channels", [&](const Value& c, const std::string& place) {
        ObjectReader r(c, place, errors_);
        if (r.require("sampler")) r.integer("sampler", 0, 0, int64_t(count) - 1);
        if (const Value* target = r.require("target") ? r.object("target") : nullptr)
          index(*target, place + ".target", "node", "nodes");
      });
    });
  }

  const Value& root_;
  const Source& source_;
  Diagnostics errors_;
  size_t lightCount_ = 0;
};

}  // namespace

void checkDocument(const Value& root, const Source& source, Diagnostics& warnings) {
  const Diagnostics errors = Checker(root, source).run(warnings);
  if (!errors.hasErrors()) return;
  // A file of another kind can be wrong in a million places.
  constexpr size_t kMaxReported = 20;
  std::vector<Diagnostic> list = errors.list();
  if (list.size() > kMaxReported) {
    const size_t more = list.size() - kMaxReported;
    list.resize(kMaxReported);
    list.push_back({Severity::Error, {source.name, 0, 0}, "", std::to_string(more) + " more mistakes", ""});
  }
  throw Error(ExitCode::BadInput, std::move(list));
}

}  // namespace fovea::scene::gltf
