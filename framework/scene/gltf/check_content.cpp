// Checks what a glTF document describes: materials, meshes, cameras, lights, the node tree, skins, animations.
#include <limits>

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

const std::string kDefault = "it has its default value", kNoTexture = "the texture is ignored";

class ContentChecker : DocumentReader {
 public:
  using DocumentReader::DocumentReader;
  void run() {
    each("materials", [&](const Value& v, const std::string& path) { checkMaterial(v, path); });
    each("meshes", [&](const Value& v, const std::string& path) { checkMesh(v, path); });
    checkCamerasAndLights();
    each("skins", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      if (!attempt("the skin is left off", [&] { checkSkin(v, path); })) wrongSkins_.insert(&v);
    });
    checkNodes();
    each("animations", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      if (attempt("the animation is left out", [&] { checkAnimation(v, path); })) return;
      for (const char* key : {"channels", "samplers"}) remove(v, key);
    });
  }

 private:
  void number(const Value& object, const std::string& path, const char* key, double min,
              double max = kNoMaximum) {
    optional(object, key, kDefault, [&] { ObjectReader(object, path, errors_).number(key, 0, min, max); });
  }

  void numbers(const Value& object, const std::string& path, const char* key, size_t count) {
    optional(object, key, kDefault, [&] { numbersIfPresent(object, path, key, count); });
  }

  void checkTextureInfo(const Value& object, const std::string& path, const char* key) {
    if (object.find(key))
      optional(object, key, kNoTexture, [&] { checkTexture(*object.find(key), path, key); });
  }

  void checkTexture(const Value& v, const std::string& path, const char* key) {
    const std::string place = json::joinPath(path, key);
    if (!v.isObject()) return error(v, place, "expected an object, found " + v.describe());
    index(v, place, "index", "textures", true);
    ObjectReader(v, place, errors_).integer("texCoord", 0, 0, 255);
    for (const char* factor : {"scale", "strength"}) number(v, place, factor, kNoMinimum);
    const Value* t = extension(v, place, "KHR_texture_transform");
    if (!t) return;
    const std::string inside = place + ".extensions.KHR_texture_transform";
    for (const char* pair : {"offset", "scale"}) numbers(*t, inside, pair, 2);
    number(*t, inside, "rotation", kNoMinimum);
    ObjectReader(*t, inside, errors_).integer("texCoord", 0, 0, 255);
  }

  void checkExtension(const Value& e, const std::string& path, const MaterialExtension& known) {
    const std::string place = path + ".extensions." + known.name;
    for (const char* key : known.numbers) number(e, place, key, 0);
    for (const char* key : known.colors) numbers(e, place, key, 3);
    for (const char* key : known.textures) checkTextureInfo(e, place, key);
    if (const Value* ior = e.find("ior"); ior && ior->isNumber() && ior->real > 0 && ior->real < 1)
      optional(e, "ior", kDefault, [&] {
        error(*ior, place + ".ior",
              "an index of refraction is at least 1, or 0 for infinity; this is " + ior->describe());
      });
  }

  void checkMaterial(const Value& v, const std::string& path) {
    nameOfObject(v, path);
    numbers(v, path, "emissiveFactor", 3);
    optional(v, "alphaMode", "it is opaque", [&] {
      ObjectReader(v, path, errors_).choice("alphaMode", "OPAQUE", {"OPAQUE", "MASK", "BLEND"});
    });
    number(v, path, "alphaCutoff", 0);
    optional(v, "doubleSided", kDefault,
             [&] { ObjectReader(v, path, errors_).boolean("doubleSided", false); });
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      checkTextureInfo(v, path, key);
    const Value* all = v.find("extensions");
    for (const MaterialExtension& known : kMaterialExtensions) {
      const Value* e = nullptr;
      const bool good = attempt("the extension is ignored", [&] { e = extension(v, path, known.name); });
      if (!good && all && all->isObject()) remove(*all, known.name);
      if (!good && all && !all->isObject()) remove(v, "extensions");
      if (e) checkExtension(*e, path, known);
    }
    const Value* pbr = nullptr;
    optional(v, "pbrMetallicRoughness", kDefault,
             [&] { pbr = ObjectReader(v, path, errors_).object("pbrMetallicRoughness"); });
    if (!pbr) return;
    const std::string place = path + ".pbrMetallicRoughness";
    numbers(*pbr, place, "baseColorFactor", 4);
    for (const char* key : {"metallicFactor", "roughnessFactor"}) number(*pbr, place, key, kNoMinimum);
    for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"})
      checkTextureInfo(*pbr, place, key);
  }

  // Without some attributes the primitive can be shown. Of a morph target, none is needed.
  void checkAttributes(const Value& v, const std::string& path) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    for (const json::Member& m : v.members) {
      const auto check = [&] { indexValue(m.value, json::joinPath(path, m.key), "accessors"); };
      if (m.key == "POSITION")
        check();
      else
        optional(v, m.key, "the attribute is ignored", check);
    }
  }

  void checkCompressed(const Value& e, const std::string& path, const Value& primitive) {
    index(e, path, "bufferView", "bufferViews", true);
    ObjectReader r(e, path, errors_);
    const Value* attributes = r.require("attributes") ? r.object("attributes") : nullptr;
    if (!attributes) return;
    ObjectReader ids(*attributes, path + ".attributes", errors_);
    for (const json::Member& a : attributes->members) {
      ids.integer(a.key, 0, 0, kIntMax);
      const Value* accessor = memberOf(primitive.find("attributes"), a.key);
      if (!accessor)
        error(a.value, path + ".attributes", "the primitive has no attribute `" + a.key.substr(0, 32) + "`");
      else
        indexValue(*accessor, path + ".attributes." + a.key, "accessors");
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
      warn(*primitives, path + ".primitives", "the list is empty: the mesh shows nothing");
    eachOf(*primitives, path + ".primitives", [&](const Value& p, const std::string& place) {
      index(p, place, "indices", "accessors");
      optional(p, "material", "it has the default material",
               [&] { index(p, place, "material", "materials"); });
      ObjectReader r(p, place, errors_);
      const Value* attributes = r.require("attributes");
      if (attributes) checkAttributes(*attributes, place + ".attributes");
      if (!attempt("the primitive is left out", [&] { r.integer("mode", 4, 0, 6); }) && attributes)
        remove(*attributes, "POSITION");
      if (const Value* targets = r.array("targets"))
        for (size_t i = 0; i < targets->items.size(); ++i)
          checkTarget(targets->items[i], at(place + ".targets", i));
      if (const Value* e = isSupported(kDraco) ? extension(p, place, kDraco) : nullptr)
        checkCompressed(*e, inside(place, kDraco), p);
    });
    checkWeights(v, path);
  }

  void checkTarget(const Value& v, const std::string& path) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    for (const json::Member& m : v.members)
      optional(v, m.key, "the displacements are ignored",
               [&] { indexValue(m.value, json::joinPath(path, m.key), "accessors"); });
  }

  void checkWeights(const Value& v, const std::string& path) {
    optional(v, "weights", "the weights are ignored", [&] {
      if (const Value* weights = ObjectReader(v, path, errors_).array("weights"))
        numbersIfPresent(v, path, "weights", weights->items.size());
    });
  }

  void checkCamerasAndLights() {
    each("cameras", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      if (!attempt("the camera is left out", [&] { checkCamera(v, path); })) wrongCameras_.insert(&v);
    });
    const Value* lights = nullptr;
    const bool good = attempt("the lights are left out", [&] {
      lights = extension(root_, "", kLights);
      if (!lights) return;
      lights_ = lights->find("lights");
      if (!lights_ || !lights_->isArray())
        error(lights_ ? *lights_ : *lights, inside("", kLights), "expected the array `lights`");
    });
    if (!good) lights_ = nullptr;
    for (size_t i = 0; lights_ && i < lights_->items.size(); ++i) {
      const Value& v = lights_->items[i];
      const std::string path = at(inside("", kLights) + ".lights", i);
      if (!attempt("the light is left out", [&] { checkLight(v, path); })) wrongLights_.insert(&v);
    }
  }

  // What a camera cannot have is replaced when it is read (gltf/camera.cpp).
  void checkCamera(const Value& v, const std::string& path) {
    ObjectReader r(v, path, errors_);
    r.choice("type", "perspective", {"perspective", "orthographic"});
    if (const Value* p = r.object("perspective")) {
      ObjectReader q(*p, path + ".perspective", errors_);
      for (const char* key : {"yfov", "znear", "zfar", "aspectRatio"}) q.number(key, 1);
    }
  }

  void checkLight(const Value& v, const std::string& path) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    nameOfObject(v, path);
    ObjectReader r(v, path, errors_);
    if (!r.require("type")) return;
    const std::string type = r.choice("type", "point", {"directional", "point", "spot"});
    numbers(v, path, "color", 3);
    r.number("intensity", 1, 0);
    number(v, path, "range", 0);
    if (type != "spot") return;
    const Value* spot = nullptr;
    optional(v, "spot", "its cone has the default angles",
             [&] { spot = r.require("spot") ? r.object("spot") : nullptr; });
    if (spot) checkCone(*spot, path + ".spot");
  }

  void checkCone(const Value& spot, const std::string& path) {
    constexpr double kRightAngle = 1.5707963267948966, kRounding = 1e-5, kDefaultOuter = 0.7853981633974483;
    for (const char* key : {"innerConeAngle", "outerConeAngle"}) number(spot, path, key, 0);
    const double inner = numberOr(&spot, "innerConeAngle", 0),
                 outer = numberOr(&spot, "outerConeAngle", kDefaultOuter);
    if (outer > kRightAngle + kRounding)
      warn(spot, path,
           "outerConeAngle " + std::to_string(outer) + " exceeds a right angle: it is clamped to one");
    if (inner >= outer)
      warn(spot, path,
           "innerConeAngle " + std::to_string(inner) + " is not below outerConeAngle " +
               std::to_string(outer) + ": the edge of its cone is hard, at outerConeAngle");
  }

  void checkNodes() {
    each("nodes", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      index(v, path, "mesh", "meshes");
      checkUse(v, path, "camera", "cameras", wrongCameras_);
      checkUse(v, path, "skin", "skins", wrongSkins_);
      indexArray(v, path, "children", "nodes");
      numbersIfPresent(v, path, "matrix", 16);
      numbersIfPresent(v, path, "translation", 3);
      numbersIfPresent(v, path, "rotation", 4);
      numbersIfPresent(v, path, "scale", 3);
      checkWeights(v, path);
      for (const char* key : {"translation", "rotation", "scale"})
        if (v.find("matrix") && v.find(key))
          warn(v, path, "has both a matrix and " + std::string(key) + ", which is ignored");
      const Value* e = nullptr;
      attempt("the light is left out", [&] { e = extension(v, path, kLights); });
      if (e) checkLightOfNode(*e, path);
    });
    each("scenes", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      indexArray(v, path, "nodes", "nodes");
    });
    // A file without scenes may still name scene 0 (and show nothing).
    if (root_.find("scenes") || (root_.find("scene") && !root_.find("scene")->isInt()))
      optional(root_, "scene", "the first scene is shown", [&] { index(root_, "", "scene", "scenes"); });
    checkNodeTree();
  }

  // A node loses what it uses if that is wrong.
  void checkUse(const Value& v, const std::string& path, const char* key, const char* list,
                const std::set<const Value*>& wrong) {
    int64_t i = -1;
    optional(v, key, "the node does without it", [&] { i = index(v, path, key, list); });
    if (i >= 0 && wrong.contains(&root_.find(list)->items[size_t(i)])) remove(v, key);
  }

  void checkLightOfNode(const Value& e, const std::string& path) {
    const Value* light = e.find("light");
    const size_t count = lights_ ? lights_->items.size() : 0;
    optional(e, "light", "the light is left out", [&] {
      if (!light || !light->isInt() || light->integer < 0 || uint64_t(light->integer) >= count)
        error(light ? *light : e, inside(path, kLights) + ".light",
              "expected an index into the model's " + std::to_string(count) + " lights");
      else if (wrongLights_.contains(&lights_->items[size_t(light->integer)]))
        remove(e, "light");
    });
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

  void checkSkin(const Value& v, const std::string& path) {
    index(v, path, "inverseBindMatrices", "accessors");
    optional(v, "skeleton", "it is not needed", [&] { index(v, path, "skeleton", "nodes"); });
    const Value* joints = v.find("joints");
    if (!joints || (joints->isArray() && joints->items.empty()))
      error(joints ? *joints : v, path, "the skin has no `joints`");
    indexArray(v, path, "joints", "nodes");
  }

  void checkAnimation(const Value& v, const std::string& path) {
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

  static constexpr double kNoMaximum = std::numeric_limits<double>::infinity(), kNoMinimum = -kNoMaximum;
  static constexpr std::string_view kLights = "KHR_lights_punctual";
  const Value* lights_ = nullptr;
  std::set<const Value*> wrongCameras_, wrongLights_, wrongSkins_;
};

}  // namespace

void checkContent(const json::Value& root, const Source& source, Findings& found) {
  ContentChecker(root, source, found).run();
}

}  // namespace fovea::scene::gltf
