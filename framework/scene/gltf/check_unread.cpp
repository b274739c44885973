// Reports what is valid in a glTF document and not read, so that nothing is left out in silence
// (samples/scenes/gltf.md lists what is read).
#include <algorithm>

#include "framework/scene/gltf/check.h"

namespace fovea::scene::gltf {
namespace {

// What extensions that are not read would have done.
constexpr std::pair<std::string_view, std::string_view> kEffects[] = {
    {"EXT_lights_ies", "the light shines without its profile"},
    {"EXT_lights_image_based", "the scene is not lit by the image"},
    {"EXT_mesh_gpu_instancing", "the mesh is shown once, not at the places of the instances"},
    {"EXT_mesh_manifold", "the mesh is shown as it is"},
    {"EXT_texture_avif", "the fall-back image of the texture is shown"},
    {"EXT_texture_webp", "the fall-back image of the texture is shown"},
    {"KHR_animation_pointer", "the property does not move"},
    {"KHR_audio", "nothing is heard"},
    {"KHR_materials_anisotropy", "the material is shown without it: its gloss has no direction"},
    {"KHR_materials_diffuse_transmission", "the material is shown without it: no light goes through"},
    {"KHR_materials_dispersion", "the material is shown without it: no light is split into colours"},
    {"KHR_materials_iridescence", "the material is shown without it: its gloss does not change colour"},
    {"KHR_materials_pbrSpecularGlossiness",
     "the material is shown without it, with its metallic-roughness factors"},
    {"KHR_materials_sheen", "the material is shown without it: it has no sheen of cloth"},
    {"KHR_materials_variants", "the first materials are shown"},
    {"KHR_materials_volume", "the material is shown without it: glass is thin and does not absorb"},
    {"KHR_node_visibility", "the node is shown"},
    {"KHR_physics_rigid_bodies", "nothing falls"},
    {"KHR_texture_basisu", "the fall-back image of the texture is shown"},
    {"KHR_xmp_json_ld", "it only describes the file"},
    {"MSFT_lod", "the first level is shown"},
    {"MSFT_texture_dds", "the fall-back image of the texture is shown"}};

// Of an object, or none.
const std::vector<json::Member>& membersOf(const json::Value* object) {
  static const std::vector<json::Member> kNone;
  return object ? object->members : kNone;
}

std::string effectOf(std::string_view extension) {
  for (const auto& [name, effect] : kEffects)
    if (name == extension) return std::string(effect);
  if (extension.starts_with("KHR_materials_")) return "the material is shown without it";
  return "what has it is shown without it";
}

class UnreadReporter : DocumentReader {
 public:
  using DocumentReader::DocumentReader;
  void run() {
    for (const json::Member& list : root_.members) {
      if (list.key == "extensions" || list.key == "extras") continue;
      for (size_t i = 0; i < list.value.items.size(); ++i)
        visit(list.value.items[i], nameOf(list.key, i, textOr(&list.value.items[i], "name", "")));
      visit(list.value, list.key);
    }
    visit(root_, "");
    reportListed();
    each("materials", [&](const Value& v, const std::string& path) {
      if (const Value* t = v.find("occlusionTexture"))
        once("occlusionTexture", *t, path, "occlusionTexture is ignored: occlusion is computed");
    });
    each("samplers", [&](const Value& v, const std::string& path) { visitSampler(v, path); });
    each("meshes", [&](const Value& v, const std::string& path) { visitMesh(v, path); });
    each("animations", [&](const Value& v, const std::string& path) { visitAnimation(v, path); });
    if (sizeOf("scenes") > 1)
      warn(*root_.find("scenes"), "scenes",
           std::to_string(sizeOf("scenes") - 1) + " other scene(s) of the file are not shown");
    for (const auto& [what, report] : reports_)
      warn(*report.where, report.path,
           report.message +
               (report.count > 1 ? " (also at " + std::to_string(report.count - 1) + " more)" : ""));
  }

 private:
  // One warning for each thing that a model asks for, at the first place.
  void once(const std::string& what, const Value& where, const std::string& path,
            const std::string& message) {
    auto [at, isNew] = reports_.try_emplace(what, Report{&where, path, message, 0});
    ++at->second.count;
  }

  // Finds extensions.
  void visit(const Value& v, const std::string& path) {
    const Value* extensions = v.find("extensions");
    if (extensions && !extensions->isObject())
      once("extensions", *extensions, path, "`extensions` is no object: it is ignored");
    for (const json::Member& e : membersOf(extensions)) {
      if (isSupported(e.key)) {
        visit(e.value, inside(path, e.key));
        continue;
      }
      seen_.insert(e.key);
      once(e.key, e.value, path, e.key.substr(0, 80) + " is ignored: " + effectOf(e.key));
    }
    if (&v == &root_) return;
    const bool isList = path.find_first_of("[.") == std::string::npos;  // whose items run() visits
    for (size_t i = 0; i < v.items.size() && !isList; ++i)
      if (v.items[i].isObject()) visit(v.items[i], at(path, i));
    for (const json::Member& m : v.members)
      if (m.key != "extensions" && m.key != "extras" && (m.value.isObject() || m.value.isArray()))
        visit(m.value, json::joinPath(path, m.key));
  }

  // Extensions that are only in the list of those that are used.
  void reportListed() {
    std::string ignored;
    const Value* used = root_.find("extensionsUsed");
    if (used && !used->isArray()) return warn(*used, "extensionsUsed", "is no list of names: it is ignored");
    for (const Value& v : itemsOf(&root_, "extensionsUsed"))
      if (v.isString() && !isSupported(v.string) && !seen_.contains(v.string))
        ignored += (ignored.empty() ? "" : ", ") + v.string.substr(0, 80);
    if (!ignored.empty())
      warn(*used, "extensionsUsed",
           "not supported, so that the model is shown without what they add: " + ignored);
  }

  // Textures are read at the level of their image, at all distances alike.
  void visitSampler(const Value& v, const std::string& path) {
    const int near = indexIn(&v, "magFilter"), far = indexIn(&v, "minFilter");
    if (near < 0 || far < 0 || isNearest(near) == isNearest(far)) return;
    once("minFilter", v, path,
         std::string("minFilter is ignored: far away, too, textures ") +
             (isNearest(near) ? "show the nearest texel" : "are interpolated") + ", as magFilter says");
  }

  static bool isNumbered(std::string_view name, std::string_view prefix) {
    return name.starts_with(prefix) && name.size() > prefix.size() &&
           name.find_first_not_of("0123456789", prefix.size()) == std::string_view::npos;
  }

  void visitMesh(const Value& mesh, const std::string& path) {
    const std::vector<Value>& primitives = itemsOf(&mesh, "primitives");
    for (size_t i = 0; i < primitives.size(); ++i) {
      const Value& p = primitives[i];
      const std::string place = at(path + ".primitives", i);
      if (!p.find("material"))
        once("material", p, place,
             "has no material: it is shown in a grey of 0.8 without metal, instead of glTF's white, rough "
             "metal");
      const Value* attributes = p.find("attributes");
      for (const json::Member& a : membersOf(attributes)) visitAttribute(*attributes, a, place);
      for (const Value& target : itemsOf(&p, "targets"))
        for (const json::Member& a : target.members)
          if (a.key != "POSITION" && a.key != "NORMAL" && !a.key.starts_with('_'))
            once("target " + a.key, a.value, place,
                 "morph targets do not change " + a.key.substr(0, 32) + ": the displacements are ignored");
    }
  }

  void visitAttribute(const Value& all, const json::Member& a, const std::string& place) {
    static constexpr std::string_view kRead[] = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};
    if (a.key.starts_with('_') ||
        isNumbered(a.key, "TEXCOORD_") ||  // an application's own; one that textures read
        std::find(std::begin(kRead), std::end(kRead), a.key) != std::end(kRead))
      return;
    const bool joints = isNumbered(a.key, "JOINTS_");
    if (joints || isNumbered(a.key, "WEIGHTS_")) {
      const std::string other = (joints ? "WEIGHTS_" : "JOINTS_") + a.key.substr(joints ? 7 : 8);
      if (!all.find(other)) once(a.key, a.value, place, a.key + " without " + other + " is ignored");
      return;
    }
    once(a.key, a.value, place, "the attribute " + a.key.substr(0, 32) + " is ignored");
  }

  void visitAnimation(const Value& animation, const std::string& path) {
    for (const Value& channel : itemsOf(&animation, "channels")) {
      const Value* target = channel.find("target");
      if (target && !target->find("node"))
        once("channel", *target, path, "a channel without a target node is ignored");
    }
  }

  struct Report {
    const Value* where;
    std::string path, message;
    size_t count;
  };
  std::map<std::string, Report> reports_;
  std::set<std::string> seen_;
};

}  // namespace

bool isNearest(int filter) { return filter == 9728 || filter == 9984 || filter == 9986; }

void checkUnread(const json::Value& root, const Source& source, Findings& found) {
  UnreadReporter(root, source, found).run();
}

}  // namespace fovea::scene::gltf
