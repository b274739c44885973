// Checks what a glTF document describes: materials, meshes, cameras, lights, the node tree, skins, animations.
#include "framework/scene/gltf/check.h"

namespace fovea::scene::gltf {
namespace {

// The members of the extensions of materials that are read.
struct MaterialExtension {
  const char* name;
  std::vector<const char*> numbers, colors, textures;
};
const MaterialExtension kMaterialExtensions[] = {
    {"KHR_materials_emissive_strength", {"emissiveStrength"}, {}, {}},
    {"KHR_materials_ior", {"ior"}, {}, {}},
    {"KHR_materials_specular",
     {"specularFactor"},
     {"specularColorFactor"},
     {"specularTexture", "specularColorTexture"}},
    {"KHR_materials_transmission", {"transmissionFactor"}, {}, {"transmissionTexture"}},
    {"KHR_materials_clearcoat",
     {"clearcoatFactor", "clearcoatRoughnessFactor"},
     {},
     {"clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"}},
    {"KHR_materials_unlit", {}, {}, {}}};

class ContentChecker : DocumentReader {
 public:
  using DocumentReader::DocumentReader;
  void run() {
    each("materials", [&](const Value& v, const std::string& path) { checkMaterial(v, path); });
    each("meshes", [&](const Value& v, const std::string& path) { checkMesh(v, path); });
    checkCamerasAndLights();
    checkNodes();
    checkSkinsAndAnimations();
  }

 private:
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

  void checkExtension(const Value& e, const std::string& path, const MaterialExtension& known) {
    const std::string place = path + ".extensions." + known.name;
    ObjectReader r(e, place, errors_);
    for (const char* key : known.numbers) r.number(key, 1, 0);
    for (const char* key : known.colors) numbersIfPresent(e, place, key, 3);
    for (const char* key : known.textures) checkTextureInfo(e, place, key);
    if (const Value* ior = e.find("ior"); ior && ior->isNumber() && ior->real != 0 && ior->real < 1)
      error(*ior, place + ".ior",
            "an index of refraction is at least 1, or 0 for infinity; this is " + ior->describe());
  }

  void checkMaterial(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    ObjectReader r(v, path, errors_);
    numbersIfPresent(v, path, "emissiveFactor", 3);
    r.choice("alphaMode", "OPAQUE", {"OPAQUE", "MASK", "BLEND"});
    r.number("alphaCutoff", 0.5);
    r.boolean("doubleSided", false);
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      checkTextureInfo(v, path, key);
    for (const MaterialExtension& known : kMaterialExtensions)
      if (const Value* e = extension(v, path, known.name)) checkExtension(*e, path, known);
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

  void checkCompressed(const Value& e, const std::string& path, const Value& primitive) {
    index(e, path, "bufferView", "bufferViews", true);
    ObjectReader r(e, path, errors_);
    const Value* attributes = r.require("attributes") ? r.object("attributes") : nullptr;
    if (!attributes) return;
    ObjectReader ids(*attributes, path + ".attributes", errors_);
    for (const json::Member& a : attributes->members) {
      ids.integer(a.key, 0, 0, kIntMax);
      if (!memberOf(primitive.find("attributes"), a.key))
        error(a.value, path + ".attributes", "the primitive has no attribute `" + a.key.substr(0, 32) + "`");
    }
    const Value* mode = primitive.find("mode");
    if (mode && mode->isInt() && mode->integer != 4 && mode->integer != 5)
      error(*mode, path, "mode " + std::to_string(mode->integer) + " cannot be compressed",
            "only triangles (4) and triangle strips (5) can");
  }

  void checkMesh(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    const Value* primitives = v.find("primitives");
    if (!primitives) return error(v, path, "the mesh has no `primitives`");
    if (primitives->isArray() && primitives->items.empty())
      error(*primitives, path + ".primitives", "the list is empty");
    eachOf(*primitives, path + ".primitives", [&](const Value& p, const std::string& place) {
      index(p, place, "indices", "accessors");
      index(p, place, "material", "materials");
      ObjectReader r(p, place, errors_);
      r.integer("mode", 4, 0, 6);
      if (const Value* attributes = r.require("attributes"))
        checkAttributes(*attributes, place + ".attributes");
      if (const Value* targets = r.array("targets"))
        for (size_t i = 0; i < targets->items.size(); ++i)
          checkAttributes(targets->items[i], at(place + ".targets", i));
      if (const Value* e = isSupported(kDraco) ? extension(p, place, kDraco) : nullptr)
        checkCompressed(*e, inside(place, kDraco), p);
    });
    if (const Value* weights = ObjectReader(v, path, errors_).array("weights"))
      numbersIfPresent(v, path, "weights", weights->items.size());
  }

  void checkCamerasAndLights() {
    each("cameras", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      r.choice("type", "perspective", {"perspective", "orthographic"});
      if (const Value* p = r.object("perspective")) {
        ObjectReader q(*p, path + ".perspective", errors_);
        for (const char* key : {"yfov", "znear", "zfar", "aspectRatio"}) q.number(key, 1);
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
      error(*spot, path + ".spot",
            "innerConeAngle " + std::to_string(inner) + " is not below outerConeAngle " +
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
      if (const Value* weights = ObjectReader(v, path, errors_).array("weights"))
        numbersIfPresent(v, path, "weights", weights->items.size());
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
      error(light ? *light : e, place,
            "expected an index into the model's " + std::to_string(lightCount_) + " lights");
  }

  // Nodes form strict trees (glTF 2.0, 3.5.1): each has at most one parent, and there are no cycles.
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
                "node " + std::to_string(child.integer) + " is a child of node " + std::to_string(p) +
                    " and of node " + std::to_string(i) + "; a node has one parent");
        p = int64_t(i);
      }
    }
    // As each node has at most one parent, walking up ends at a root or in a cycle.
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
        error(nodes->items[size_t(n)], at("nodes", size_t(n)),
              "node " + std::to_string(n) + " is its own ancestor");
      for (size_t w : walk) known[w] = 2;
    }
  }

  void checkSkinsAndAnimations() {
    each("skins", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "inverseBindMatrices", "accessors");
      index(v, path, "skeleton", "nodes");
      const Value* joints = v.find("joints");
      if (!joints || (joints->isArray() && joints->items.empty()))
        error(joints ? *joints : v, path, "the skin has no `joints`");
      indexArray(v, path, "joints", "nodes");
    });
    each("animations", [&](const Value& v, const std::string& path) { checkAnimation(v, path); });
  }

  void checkAnimation(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    const Value* samplers = listOf(v, path, "samplers");
    const Value* channels = listOf(v, path, "channels");
    if (!samplers || !channels) return;
    eachOf(*samplers, path + ".samplers", [&](const Value& s, const std::string& place) {
      index(s, place, "input", "accessors", true);
      index(s, place, "output", "accessors", true);
      ObjectReader(s, place, errors_).choice("interpolation", "LINEAR", {"LINEAR", "STEP", "CUBICSPLINE"});
    });
    const size_t count = samplers->isArray() ? samplers->items.size() : 0;
    eachOf(*channels, path + ".channels", [&](const Value& c, const std::string& place) {
      ObjectReader r(c, place, errors_);
      if (r.require("sampler")) r.integer("sampler", 0, 0, int64_t(count) - 1);
      const Value* target = r.require("target") ? r.object("target") : nullptr;
      if (!target) return;
      index(*target, place + ".target", "node", "nodes");
      ObjectReader t(*target, place + ".target", errors_);
      if (t.require("path")) t.text("path");
    });
  }

  // A list that must not be empty; nullptr if it is absent.
  const Value* listOf(const Value& v, const std::string& path, std::string_view key) {
    const Value* list = v.find(key);
    if (list && !(list->isArray() && list->items.empty())) return list;
    error(list ? *list : v, json::joinPath(path, key),
          "the animation has no `" + std::string(key) + "`: nothing moves");
    return nullptr;
  }

  size_t lightCount_ = 0;
};

}  // namespace

void checkContent(const json::Value& root, const Source& source, Diagnostics& errors) {
  ContentChecker(root, source, errors).run();
}

}  // namespace fovea::scene::gltf
